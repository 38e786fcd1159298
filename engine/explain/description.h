// Keys of dataset.toml, each read strictly: what is wrong is told with file, line and key.
#pragma once

#include <string>
#include <vector>

#include "core/types.h"
#include "explain/dataset.h"
#include "scene/toml_document.h"

namespace cathlab {

/// The member `key` of a table; throws UserError where it is missing or of another kind (wanted: words for the
/// sentence).
const TomlNode& described(const TomlNode& table, const std::string& key, TomlKind kind, const char* wanted);

/// A finite number; throws UserError.
double described_number(const TomlNode& node, const std::string& key);
/// The member `key`, a number above 0; throws UserError.
double described_above_zero(const TomlNode& table, const std::string& key);
/// Three finite numbers; throws UserError.
Vec3 described_vector(const TomlNode& node, const std::string& key);
/// The same as a unit vector; throws UserError for one of length 0 too.
Vec3 described_direction(const TomlNode& node, const std::string& key);
/// Throws UserError for a key that is not among the known ones, with the nearest of them.
void refuse_unknown(const TomlNode& table, const std::vector<std::string>& known);

/// A number, 0 or more; throws UserError.
double described_not_below_zero(const TomlNode& table, const std::string& key);

/// [setup] of kind catheter-tip.
CatheterTipSetup catheter_setup(const TomlNode& setup);
/// [setup] of kind tendon-tip; the columns are found later, by find_tendons.
TendonTipSetup tendon_setup(const TomlNode& setup);

/// [setup] of kind wall-contact; `folder` is where its mesh lies.
WallContactSetup contact_setup(const TomlNode& setup, const std::string& folder);

}  // namespace cathlab
