// Where on the wall a run pressed, and how much: by region, and over the aorta unrolled along its centre-line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "world/world.h"

namespace cathlab {

/// Impulse of the contact forces over the unrolled way from the heart (or the end farthest from the entry) to the
/// anatomy's first entry site.
struct UnrolledForces {
    static constexpr double along_mm = 10.0;
    static constexpr int sectors = 12;
    std::vector<double> impulse_ns;  ///< row after row of `sectors`, one row each along_mm from the heart down

    void add(const UnrolledForces& other);
};

/// force-map.csv: along_mm, angle_deg (middles of the cells), impulse_ns; cells without any are left out but the last.
std::string force_map_csv(const UnrolledForces& forces);
/// Throws UserError that names `path` and the line where the text is no such table.
UnrolledForces parse_force_map(std::string_view text, const std::string& path);

class ForceMap {
public:
    explicit ForceMap(const World& world);

    /// After every step: the normal forces of its last substep, for dt s.
    void add(const World& world, double dt);

    /// regions.csv: region, force_max_n (of the sum there), impulse_ns, contact_s; regions that were touched, by name.
    std::string regions_csv() const;
    /// Angle 0 looks to the front (-y) at the way's lower end, 90 to the patient's left there; carried along the way
    /// without twist.  Of the wall at rest.
    UnrolledForces unrolled() const;

private:
    struct RegionSum {
        std::string name;
        double now_mn = 0.0, max_mn = 0.0, impulse_mns = 0.0, contact_s = 0.0;
    };
    std::vector<RegionSum> regions_;
    std::vector<double> impulse_mns_;  // a triangle
    std::vector<int> cell_;            // a triangle's; -1 = off the way
    std::size_t rows_ = 0;
};

}  // namespace cathlab
