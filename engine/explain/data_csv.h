// The table of a data set.
#pragma once

#include <string>

#include "explain/dataset.h"

namespace cathlab {

/// Fills run, time_s, held_out, columns and labels of `out`, whose kind must be known.  Throws UserError with file,
/// line and column.
void read_data_csv(const std::string& path, Dataset& out);

}  // namespace cathlab
