// sums.json: a hash of every file of a run folder, so that one changed byte is found.
#pragma once

#include <string>
#include <vector>

namespace cathlab {

/// Writes sums.json over every file that lies in the folder (not in folders below it), itself left out.  Call it when
/// the run is closed.  Throws UserError.
void write_sums(const std::string& folder);

/// One sentence for each file that was changed, is missing or was added since; empty = none.  Throws UserError where
/// there is no sums.json or it is none.
std::vector<std::string> check_sums(const std::string& folder);

}  // namespace cathlab
