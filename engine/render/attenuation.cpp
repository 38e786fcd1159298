#include "render/attenuation.h"

#include <cmath>

#include "core/errors.h"

namespace cathlab {

namespace {

constexpr std::size_t steps_per_bin = 12;
constexpr std::array<double, 6> table_kev = {50, 60, 65, 70, 80, 100};
struct Row {
    const char* name;
    std::array<double, 6> mu_per_cm;
};
constexpr std::array<Row, 18> table = {{
    {"water", {.2269, .2059, .1987, .1929, .1837, .1707}},
    {"soft_tissue", {.2223, .2025, .1957, .1901, .1813, .1688}},
    {"adipose", {.1953, .1819, .1770, .1729, .1662, .1559}},
    {"blood", {.2403, .2174, .2096, .2032, .1934, .1795}},
    {"cortical_bone", {.767, .574, .516, .472, .411, .344}},
    {"lung", {.0589, .0532, .0515, .0498, .0475, .0441}},
    {"pa12", {.210, .197, .192, .188, .181, .170}},
    {"ptfe", {.469, .414, .395, .381, .359, .330}},
    {"nitinol", {12.31, 7.59, 6.19, 5.16, 3.77, 2.37}},
    {"stainless_steel", {16.42, 10.10, 8.22, 6.83, 4.97, 3.08}},
    {"platinum", {149.2, 93.1, 75.8, 62.8, 187.3, 107.1}},
    {"gold", {140.1, 87.4, 71.2, 58.9, 42.2, 99.6}},
    {"tungsten", {114.5, 71.5, 58.2, 212.4, 150.3, 85.4}},
    {"polymer_tungsten", {20.0, 12.6, 10.3, 37.0, 26.2, 15.0}},
    {"polymer_baso4", {5.02, 3.17, 2.60, 2.16, 1.57, .95}},
    {"iodine", {12.32, 7.58, 6.12, 5.02, 3.51, 1.94}},
    {"trabecular_bone", {.41, .34, .315, .298, .273, .24}},
    {"air", {0, 0, 0, 0, 0, 0}},
}};

double log_log(const double* x, const double* y, std::size_t n, double at) {
    std::size_t i = 0;
    while (i + 2 < n && x[i + 1] < at) ++i;
    if (y[i] <= 0) return 0;
    const double t = std::log(at / x[i]) / std::log(x[i + 1] / x[i]);
    return y[i] * std::exp(t * std::log(y[i + 1] / y[i]));
}

// Filters and scintillator: mass attenuation coefficients in cm2/g (NIST XCOM).
constexpr std::array<double, 8> filter_kev = {20, 30, 40, 50, 60, 80, 100, 150};
constexpr std::array<double, 8> aluminium = {3.441, 1.128, .5685, .3681, .2778, .2018, .1704, .1378};
constexpr std::array<double, 8> copper = {33.79, 10.92, 4.862, 2.613, 1.593, .7630, .4584, .2217};
constexpr std::array<double, 8> caesium_iodide = {0, 9.0, 22.97, 12.87, 7.921, 3.677, 2.035, .7551};

}  // namespace

BeamTable::BeamTable(double kvp, double copper_mm) {
    if (!(kvp >= 40 && kvp <= 150)) throw UserError("tube voltage must lie in [40, 150] kV");
    if (!(copper_mm >= 0 && copper_mm <= 1.5)) throw UserError("copper filter must lie in [0, 1.5] mm");
    const double lowest = 28.0;
    const std::size_t n = energy_bins * steps_per_bin;
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double e = lowest + (kvp - lowest) * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
        const double al = log_log(filter_kev.data(), aluminium.data(), 8, e) * 2.699 * 0.25;
        const double cu = log_log(filter_kev.data(), copper.data(), 8, e) * 8.96 * 0.1 * copper_mm;
        const double csi = log_log(filter_kev.data() + 1, caesium_iodide.data() + 1, 7, e) * 4.51 * 0.055;
        const double w = (kvp - e) / e * std::exp(-al - cu) * e * (1 - std::exp(-csi));
        energy_kev_.push_back(e);
        weight_.push_back(w);
        sum += w;
    }
    for (std::size_t i = 0; i < n; ++i) {
        weight_[i] /= sum;
        weights_[i / steps_per_bin] += static_cast<float>(weight_[i]);
    }
}

BinValues BeamTable::attenuation(const std::string& material) const {
    const Row* row = nullptr;
    std::vector<std::string> names;
    for (const Row& r : table) {
        names.emplace_back(r.name);
        if (material == r.name) row = &r;
    }
    if (row == nullptr) {
        throw UserError("unknown X-ray material '" + material + "'" + did_you_mean(material, names) + "; known are " +
                        comma_list(names));
    }
    BinValues mu{};
    for (std::size_t i = 0; i < energy_kev_.size(); ++i) {
        const double at = log_log(table_kev.data(), row->mu_per_cm.data(), table_kev.size(), energy_kev_[i]) / 10.0;
        mu[i / steps_per_bin] += static_cast<float>(at * weight_[i]);
    }
    for (std::size_t k = 0; k < energy_bins; ++k) mu[k] /= weights_[k];
    return mu;
}

BinValues BeamTable::iodine() const {
    BinValues mu = attenuation("iodine");
    for (float& m : mu) m *= 1e-3F;  // the table's g/cm3 are 1000 mg/mL
    return mu;
}

}  // namespace cathlab
