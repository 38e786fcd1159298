// Pictures of the closed forms for docs/plots: written where the environment variable CATHLAB_PLOTS names a folder.
#pragma once

#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "core/svg_plot.h"

namespace cathlab::test {

/// A line of theory from x0 to x1 and points of the simulation over it.
inline Plot theory_and_points(const std::string& title, const std::string& x_label, const std::string& y_label,
                              double x0, double x1, const std::function<double(double)>& theory) {
    Plot plot;
    plot.title = title;
    plot.x_label = x_label;
    plot.y_label = y_label;
    PlotCurve line, points;
    line.label = "closed form";
    line.style = CurveStyle::reference;
    for (int i = 0; i <= 200; ++i) {
        line.x.push_back(x0 + (x1 - x0) * i / 200.0);
        line.y.push_back(theory(line.x.back()));
    }
    points.label = "simulated";
    points.marks = true;
    points.line = false;
    plot.curves = {line, points};
    return plot;
}

inline void add_point(Plot& plot, double x, double y) {
    plot.curves.back().x.push_back(x);
    plot.curves.back().y.push_back(y);
}

inline void keep(const Plot& plot, const std::string& name) {
    const char* folder = std::getenv("CATHLAB_PLOTS");
    if (folder != nullptr) std::ofstream(std::string(folder) + "/" + name + ".svg") << svg_plot(plot);
}

}  // namespace cathlab::test
