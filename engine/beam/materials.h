// What X-rays meet: materials by name, their composition, density and attenuation between 20 and 150 keV.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cathlab {

/// Part of a material's mass that is one element.
struct MassFraction {
    int atomic_number;
    double fraction;
};

struct Material {
    std::string_view name;
    double density_g_cm3;
    std::vector<MassFraction> composition;  ///< sums to 1
    std::string_view source;                ///< key of docs/references.md
    std::string_view doc;
};

/// All materials, in the order in which they are listed.  "iodine" is the element at 1 g/cm3: contrast medium of c
/// mgI/mL adds c / 1000 of it.
std::span<const Material> material_table();

/// nullptr where there is none of that name.
const Material* find_material(std::string_view name);

/// Throws UserError with the nearest known name.
const Material& material(std::string_view name);

/// How a coefficient is read between the table's energies, in logarithms of both.
enum class TableReading {
    cubic,    ///< through the four nearest on the same side of the K edge: within 0.1 % of xraylib
    straight  ///< from one to the next: up to 0.4 % high.  The exposure control reckons with these numbers, and with
              ///< them the states of recorded runs
};

/// Total mass attenuation coefficient (photo-electric, coherent, incoherent), cm2/g; K edges exact.  energy_kev from 20
/// to 150, clamped.
double mass_attenuation_cm2_g(const Material& material, double energy_kev, TableReading way = TableReading::cubic);
double mass_attenuation_cm2_g(int atomic_number, double energy_kev, TableReading way = TableReading::cubic);

/// Linear attenuation at the material's density, 1/mm.
double attenuation_per_mm(const Material& material, double energy_kev, TableReading way = TableReading::cubic);

/// Mass energy-absorption coefficient of dry air, cm2/g: turns fluence into air kerma [hubbell1995].
double air_energy_absorption_cm2_g(double energy_kev);

}  // namespace cathlab
