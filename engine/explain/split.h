// Which rows the fit may see and which judge it.
#pragma once

#include <cstdint>
#include <vector>

#include "explain/dataset.h"

namespace cathlab {

struct Split {
    std::vector<std::uint8_t> held_out;  ///< (rows) 1 = judges
    std::vector<Index> block;            ///< (rows) blocks of time that stand for one another in a permutation
    Index blocks = 0;
    /// So many of the measured columns, the first ones, are of one unit and make the error's root mean square; 0 = all.
    std::size_t judged = 0;
};

/// The column `part` where there is one.  Otherwise every run is cut into thirty blocks of time and every third block
/// is held out: whole blocks, never single rows, since neighbours know of one another; and every run shows its rest
/// position in the part that is fitted.
Split split_rows(const Dataset& data);

}  // namespace cathlab
