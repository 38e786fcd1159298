// Results of trials as they lie in the run folders, for comparison.
#pragma once

#include <string>
#include <vector>

#include "play/screens.h"

namespace cathlab::play {

/// The newest of the task below a folder, without `except`; what cannot be read is left out.
std::vector<ResultView::Earlier> earlier_trials(const std::string& folder, const std::string& task,
                                                const std::string& except);

}  // namespace cathlab::play
