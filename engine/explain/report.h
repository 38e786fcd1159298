// An explanation as a page to read and print.
#pragma once

#include <string>

#include "core/html_page.h"
#include "explain/tracer.h"

namespace cathlab {

/// Error before, after and floor; the effects found and their numbers; every candidate and why it was refused; what is
/// left; plots: measured against model, residual over time and against what it depends on, spectrum.
///   command   what made it, for the last line
Page explain_page(const Dataset& data, const Explanation& found, const std::string& command);

/// The explanation in a few sentences.
std::vector<std::string> explain_sentences(const Dataset& data, const Explanation& found);

}  // namespace cathlab
