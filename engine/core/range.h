// One check and one sentence for a user's number that must lie in a range.
#pragma once

#include <string>

#include "core/errors.h"

namespace cathlab {

/// Passes where `value` is finite and least <= value <= most (in the key's own unit); otherwise throws UserError:
/// "scene.toml:12: wire.length_mm: found -1, allowed is 0 to 3000".  `key` takes the place of where.key.
void require_range(const SourcePlace& where, const std::string& key, double value, double least, double most);

}  // namespace cathlab
