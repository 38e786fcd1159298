// What a cached picture of a view depends on, as numbers that are compared.  For this room's .cpp files only.
#pragma once

#include <cmath>
#include <vector>

#include "render/frame_description.h"

namespace cathlab {

struct ViewKey {
    std::vector<double> numbers;
    bool operator==(const ViewKey&) const = default;
};

inline void append(ViewKey& key, const Vec3& v) {
    key.numbers.insert(key.numbers.end(), v.data(), v.data() + 3);
}

inline ViewKey view_key(const FrameDescription& f, int width, int height) {
    ViewKey key;
    for (const Vec3& v : {f.view.source, f.view.detector_center, f.view.right, f.view.down}) append(key, v);
    key.numbers.insert(key.numbers.end(),
                       {f.view.width_mm, f.view.height_mm, f.view.source_isocentre_mm, double(width), double(height)});
    return key;
}

// Generators step by whole kilovolts; so the context is not made anew for every small turn of the exposure control.
inline double generator_kvp(const FrameExposure& e) {
    return std::round(e.kvp);
}

inline ViewKey context_key(const FrameDescription& f, int width, int height) {
    ViewKey key = view_key(f, width, height);
    key.numbers.insert(key.numbers.end(),
                       {generator_kvp(f.exposure), f.exposure.copper_mm, f.exposure.scatter_to_primary.value_or(-1.0),
                        f.exposure.measuring_field, f.view.open_width, f.view.open_height, double(f.solids_revision)});
    for (const FrameSolid& solid : f.solids) {
        if (solid.moving) continue;
        append(key, solid.pose.position);
        const auto& q = solid.pose.orientation.coeffs();
        key.numbers.insert(key.numbers.end(), q.data(), q.data() + 4);
    }
    return key;
}

}  // namespace cathlab
