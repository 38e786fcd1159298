// Which places on which devices move which control.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "play/controls.h"
#include "play/source.h"
#include "scene/toml_table.h"

namespace cathlab::play {

struct Bindings {
    std::array<std::vector<Source>, control_count> sources;

    std::vector<Source>& of(Control c) { return sources[static_cast<std::size_t>(c)]; }
    const std::vector<Source>& of(Control c) const { return sources[static_cast<std::size_t>(c)]; }

    /// Gives a place to a control and takes it from whichever had it; returns that one.
    std::optional<Control> bind(Control control, const Source& source);
    /// The places of one device family, for the help: "W, S".
    std::string labels(Control control, bool pad) const;

    bool operator==(const Bindings&) const = default;
};

Bindings default_bindings();

/// [bindings] of the settings file: control = ["pad:leftx", "key:D", "key:A:-"].
Table<Bindings> bindings_table();

}  // namespace cathlab::play
