// Where a calibration leaves what it found: the overlay and the report, each written whole or not at all.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/html_page.h"

namespace cathlab {

class CalibrationOutput {
public:
    /// Looks at both places before the work begins: throws UserError where a folder is missing or a file stands there
    /// that no calibration has written.  report = a folder, made if need be; "" = no report.
    CalibrationOutput(std::string overlay, std::string report);

    /// Writes overlay (with `notes` as comments above it) and report; each beside its place and renamed.
    void write(const std::string& toml, const std::vector<std::string>& notes, const Page& page) const;

    /// "overlay.toml" or "overlay.toml and report/report.html".
    std::string places() const;

private:
    std::string overlay_, report_;
};

/// Rows aligned in columns, for the terminal.
std::string table_text(const PageTable& table);

/// "wall.cluster_stiffness=0.4:0.9" -> path and range; throws UserError (wrong use).
struct FreeRange {
    std::string path;
    double low = 0.0, high = 0.0;
};
FreeRange parse_free(const std::string& text);

/// "20:580" -> both numbers; throws UserError (wrong use) for anything else, and where the second is not above the
/// first.  option = for the sentence.
std::pair<double, double> parse_range(const std::string& option, const std::string& text);

}  // namespace cathlab
