// Where an explanation leaves what it found: a folder with result.json, report.html and, where an effect was found,
// overlay.toml.
#pragma once

#include <string>

#include "explain/tracer.h"

namespace cathlab {

class ExplainOutput {
public:
    /// Looks at the place before the work begins: throws UserError where a file stands there, or a folder with anything
    /// in it that no explanation has written.
    explicit ExplainOutput(std::string folder);

    /// Makes the folder and writes each file beside its place and renames it.
    void write(const Dataset& data, const Explanation& found, const ExplainOptions& options, double seconds,
               const std::string& command) const;

    const std::string& folder() const { return folder_; }

private:
    std::string folder_;
};

}  // namespace cathlab
