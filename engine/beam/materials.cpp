#include "beam/materials.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "core/deterministic_math.h"
#include "core/errors.h"

namespace cathlab {
namespace {

constexpr std::size_t grid_size = 42;
constexpr double grid_first_kev = 20.0;
constexpr double grid_step = 0.05;  // of the logarithm

struct ElementRow {
    int atomic_number;
    double edge_kev, below, above;
    std::array<double, grid_size> grid;
};

const std::vector<ElementRow>& element_rows() {
    static const std::vector<ElementRow> rows = {
#include "beam/attenuation_table.inl"
    };
    return rows;
}

double log_log(double log_e, double log_e0, double y0, double log_e1, double y1) {
    const double t = (log_e - log_e0) / (log_e1 - log_e0);
    return det::exp(det::log(y0) + t * (det::log(y1) - det::log(y0)));
}

double straight(const ElementRow& row, double log_e) {
    const double log_first = det::log(grid_first_kev);
    const auto k = std::min(static_cast<std::size_t>((log_e - log_first) / grid_step), grid_size - 2);
    double log_low = log_first + grid_step * static_cast<double>(k), log_high = log_low + grid_step;
    double low = row.grid[k], high = row.grid[k + 1];
    if (row.edge_kev > 0.0) {
        const double log_edge = det::log(row.edge_kev);
        if (log_edge > log_low && log_edge < log_high) {
            if (log_e < log_edge) {
                log_high = log_edge;
                high = row.below;
            } else {
                log_low = log_edge;
                low = row.above;
            }
        }
    }
    return log_log(log_e, log_low, low, log_high, high);
}

// An element's points on either side of its K edge, the edge's own among them.
struct ElementCurve {
    struct Point {
        double log_e, log_mu;
    };
    int atomic_number;
    double log_edge;
    std::vector<Point> below, above;
};

const std::vector<ElementCurve>& element_curves() {
    static const std::vector<ElementCurve> curves = [] {
        std::vector<ElementCurve> out;
        for (const ElementRow& row : element_rows()) {
            ElementCurve curve{row.atomic_number, row.edge_kev > 0.0 ? det::log(row.edge_kev) : 0.0, {}, {}};
            for (std::size_t k = 0; k < grid_size; ++k) {
                const double log_e = det::log(grid_first_kev) + grid_step * static_cast<double>(k);
                (log_e < curve.log_edge ? curve.below : curve.above).push_back({log_e, det::log(row.grid[k])});
            }
            if (row.edge_kev > 0.0) {
                curve.below.push_back({curve.log_edge, det::log(row.below)});
                curve.above.insert(curve.above.begin(), {curve.log_edge, det::log(row.above)});
            }
            out.push_back(std::move(curve));
        }
        return out;
    }();
    return curves;
}

double cubic(const ElementCurve& curve, double log_e) {
    const std::vector<ElementCurve::Point>& points = log_e < curve.log_edge ? curve.below : curve.above;
    std::size_t first = 0;
    while (first + 4 < points.size() && log_e > points[first + 2].log_e) ++first;
    double sum = 0.0;
    for (std::size_t i = first; i < first + 4; ++i) {
        double term = points[i].log_mu;
        for (std::size_t j = first; j < first + 4; ++j)
            if (j != i) term *= (log_e - points[j].log_e) / (points[i].log_e - points[j].log_e);
        sum += term;
    }
    return det::exp(sum);
}

template <class Rows>
const auto& row_of(const Rows& rows, int atomic_number) {
    const auto it =
        std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.atomic_number == atomic_number; });
    CATHLAB_CHECK(it != rows.end(), "no attenuation data for this element");
    return *it;
}

std::vector<Material> build_table() {
    // Compositions by mass.  Alloys and compounds follow from their formulae; tissues are ICRU's and ICRP's as compiled
    // in [schoonjans2011].
    return {
        {"air",
         0.001205,
         {{6, 0.000124}, {7, 0.755267}, {8, 0.231782}, {18, 0.012827}},
         "schoonjans2011",
         "dry air near sea level"},
        {"water", 1.0, {{1, 0.111894}, {8, 0.888106}}, "schoonjans2011", "liquid water"},
        {"soft_tissue",
         1.0,
         {{1, 0.101172}, {6, 0.111}, {7, 0.026}, {8, 0.761828}},
         "icru33",
         "ICRU four-component soft tissue"},
        {"adipose",
         0.92,
         {{1, 0.119477},
          {6, 0.63724},
          {7, 0.00797},
          {8, 0.232333},
          {11, 0.0005},
          {12, 2e-05},
          {15, 0.00016},
          {16, 0.00073},
          {17, 0.00119},
          {19, 0.00032},
          {20, 2e-05},
          {26, 2e-05},
          {30, 2e-05}},
         "schoonjans2011",
         "fat, ICRP"},
        {"blood",
         1.06,
         {{1, 0.101866},
          {6, 0.10002},
          {7, 0.02964},
          {8, 0.759414},
          {11, 0.00185},
          {12, 4e-05},
          {14, 3e-05},
          {15, 0.00035},
          {16, 0.00185},
          {17, 0.00278},
          {19, 0.00163},
          {20, 6e-05},
          {26, 0.00046},
          {30, 1e-05}},
         "schoonjans2011",
         "blood, ICRP"},
        {"cortical_bone",
         1.85,
         {{1, 0.047234},
          {6, 0.14433},
          {7, 0.04199},
          {8, 0.446096},
          {12, 0.0022},
          {15, 0.10497},
          {16, 0.00315},
          {20, 0.20993},
          {30, 0.0001}},
         "schoonjans2011",
         "cortical bone, ICRP"},
        {"trabecular_bone",
         1.18,
         {{1, 0.085},
          {6, 0.404},
          {7, 0.028},
          {8, 0.367},
          {11, 0.001},
          {12, 0.001},
          {15, 0.034},
          {16, 0.002},
          {17, 0.002},
          {19, 0.001},
          {20, 0.074},
          {26, 0.001}},
         "icru46",
         "spongiosa: vertebral bodies"},
        {"lung",
         0.26,
         {{1, 0.101278},
          {6, 0.10231},
          {7, 0.02865},
          {8, 0.757072},
          {11, 0.00184},
          {12, 0.00073},
          {15, 0.0008},
          {16, 0.00225},
          {17, 0.00266},
          {19, 0.00194},
          {20, 9e-05},
          {26, 0.00037},
          {30, 1e-05}},
         "icru46",
         "inflated lung (tissue of ICRP at the density of ICRU 46)"},
        {"polymer",
         1.01,
         {{1, 0.11751}, {6, 0.73049}, {7, 0.07099}, {8, 0.08101}},
         "schoonjans2011",
         "polyamide 12 and block copolymers of it, C12H23NO"},
        {"ptfe", 2.2, {{6, 0.240183}, {9, 0.759817}}, "schoonjans2011", "liner and sheath"},
        {"barium_polymer",
         1.46,
         {{1, 0.070506}, {6, 0.438294}, {7, 0.042594}, {8, 0.158288}, {16, 0.054952}, {56, 0.235366}},
         "schoonjans2011",
         "polyamide 12 with 40 % barium sulphate by mass"},
        {"tungsten_polymer",
         4.17,
         {{1, 0.023502}, {6, 0.146098}, {7, 0.014198}, {8, 0.016202}, {74, 0.8}},
         "schoonjans2011",
         "polyamide 12 with 80 % tungsten by mass: marker bands, jackets of guidewires"},
        {"nitinol", 6.45, {{22, 0.44}, {28, 0.56}}, "schoonjans2011", "nickel-titanium, 56 % nickel by mass"},
        {"stainless_steel",
         8.0,
         {{24, 0.17}, {25, 0.015}, {26, 0.67}, {28, 0.12}, {42, 0.025}},
         "schoonjans2011",
         "316L"},
        {"platinum", 21.45, {{78, 1.0}}, "schoonjans2011", "tip coils and marker bands"},
        {"gold", 19.3, {{79, 1.0}}, "schoonjans2011", "marker bands"},
        {"tungsten", 19.25, {{74, 1.0}}, "schoonjans2011", "tip coils"},
        {"iodine", 1.0, {{53, 1.0}}, "schoonjans2011", "per g/cm3 of the element, for contrast medium"},
        {"aluminium", 2.699, {{13, 1.0}}, "schoonjans2011", "filter of the tube"},
        {"copper", 8.96, {{29, 1.0}}, "schoonjans2011", "filter of the tube"},
        {"caesium_iodide", 4.51, {{53, 0.488451}, {55, 0.511549}}, "schoonjans2011", "scintillator of the flat panel"},
    };
}

}  // namespace

std::span<const Material> material_table() {
    static const std::vector<Material> table = build_table();
    return table;
}

const Material* find_material(std::string_view name) {
    for (const Material& material : material_table())
        if (material.name == name) return &material;
    return nullptr;
}

const Material& material(std::string_view name) {
    if (const Material* found = find_material(name)) return *found;
    std::vector<std::string> names;
    for (const Material& known : material_table()) names.emplace_back(known.name);
    throw UserError("there is no material '" + std::string(name) + "'" + did_you_mean(std::string(name), names) +
                    "; known are " + comma_list(names));
}

double mass_attenuation_cm2_g(int atomic_number, double energy_kev, TableReading way) {
    const double log_e = std::clamp(det::log(energy_kev), det::log(grid_first_kev), det::log(150.0));
    return way == TableReading::cubic ? cubic(row_of(element_curves(), atomic_number), log_e)
                                      : straight(row_of(element_rows(), atomic_number), log_e);
}

double mass_attenuation_cm2_g(const Material& material, double energy_kev, TableReading way) {
    double sum = 0.0;
    for (const MassFraction& part : material.composition)
        sum += part.fraction * mass_attenuation_cm2_g(part.atomic_number, energy_kev, way);
    return sum;
}

double attenuation_per_mm(const Material& material, double energy_kev, TableReading way) {
    return 0.1 * material.density_g_cm3 * mass_attenuation_cm2_g(material, energy_kev, way);
}

double air_energy_absorption_cm2_g(double energy_kev) {
    constexpr std::array<std::array<double, 2>, 8> table = {{{20.0, 0.5389},
                                                             {30.0, 0.1537},
                                                             {40.0, 0.06833},
                                                             {50.0, 0.04098},
                                                             {60.0, 0.03041},
                                                             {80.0, 0.02407},
                                                             {100.0, 0.02325},
                                                             {150.0, 0.02496}}};
    // Cubic through the four nearest, in logarithms: the curve bends too much between 20 and 60 keV for straight lines.
    const double x = det::log(std::clamp(energy_kev, 20.0, 150.0));
    std::size_t k = 0;
    while (k + 4 < table.size() && x > det::log(table[k + 2][0])) ++k;
    double sum = 0.0;
    for (std::size_t i = k; i < k + 4; ++i) {
        double term = det::log(table[i][1]);
        for (std::size_t j = k; j < k + 4; ++j)
            if (j != i) term *= (x - det::log(table[j][0])) / (det::log(table[i][0]) - det::log(table[j][0]));
        sum += term;
    }
    return det::exp(sum);
}

}  // namespace cathlab
