#include "render/shutter.h"

namespace cathlab {

void blacken_shaded(const CArmView& view, std::size_t columns, std::vector<std::uint8_t>& grey) {
    if (view.open_width >= 1 && view.open_height >= 1) return;
    const std::size_t rows = grey.size() / columns;
    const int width = static_cast<int>(columns), height = static_cast<int>(rows);
    for (std::size_t i = 0; i < grey.size(); ++i) {
        const bool lit = is_open(static_cast<double>(i % columns) + 0.5, width, view.open_width) &&
                         is_open(static_cast<double>(i / columns) + 0.5, height, view.open_height);
        if (!lit) grey[i] = 0;
    }
}

}  // namespace cathlab
