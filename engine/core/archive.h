// One `visit(Archive&, XState&)` a state serves hashing, logging and printing: the archive sees each field once, by
// name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/types.h"

namespace cathlab {

class Archive {
public:
    virtual ~Archive() = default;

    void field(std::string_view name, double& v) { numbers(name, &v, 1); }
    void field(std::string_view name, float& v) { numbers(name, &v, 1); }
    void field(std::string_view name, std::int64_t& v) { numbers(name, &v, 1); }
    void field(std::string_view name, Vec3& v) { numbers(name, v.data(), 3); }
    void field(std::string_view name, Quat& v) { numbers(name, v.coeffs().data(), 4); }
    void field(std::string_view name, Pose& v) {
        field(name, v.position);
        field(name, v.orientation);
    }
    void field(std::string_view name, bool& v) {
        std::int64_t wide = v ? 1 : 0;
        numbers(name, &wide, 1);
        v = wide != 0;
    }
    void field(std::string_view name, Index& v) {
        std::int64_t wide = v;
        numbers(name, &wide, 1);
        v = static_cast<Index>(wide);
    }
    void field(std::string_view name, std::vector<double>& v) { numbers(name, v.data(), v.size()); }
    void field(std::string_view name, std::vector<float>& v) { numbers(name, v.data(), v.size()); }
    void field(std::string_view name, std::vector<std::int64_t>& v) { numbers(name, v.data(), v.size()); }
    void field(std::string_view name, std::vector<Vec3>& v) {
        numbers(name, v.empty() ? nullptr : v.front().data(), 3 * v.size());
    }
    void field(std::string_view name, std::vector<Quat>& v) {
        numbers(name, v.empty() ? nullptr : v.front().coeffs().data(), 4 * v.size());
    }

protected:
    virtual void numbers(std::string_view name, double* data, std::size_t size) = 0;
    virtual void numbers(std::string_view name, float* data, std::size_t size) = 0;
    virtual void numbers(std::string_view name, std::int64_t* data, std::size_t size) = 0;
};

}  // namespace cathlab
