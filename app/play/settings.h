// What a trainee may set, and the file that keeps it.
#pragma once

#include <string>

#include "play/bindings.h"
#include "play/stick.h"

namespace cathlab::play {

struct InputSettings {
    StickShape stick;
    double advance_mm_s = 40.0;   ///< at full deflection
    double rotate_deg_s = 180.0;  ///< of the device at the sheath
    double bend_deg_s = 40.0;
    double direction_deg_s = 90.0;  ///< of the direction of bend
    double c_arm_deg_s = 20.0;
    double table_mm_s = 120.0;
    double contrast_ml_s = 8.0;
    double precision = 0.25;  ///< share of the speed while "slowly" is held
    double jog_mm = 1.0;
    bool left_handed = false;    ///< the sticks, triggers and shoulders change sides
    bool toggle_pedals = false;  ///< pedals stay down until they are pressed again
    double rumble = 1.0;         ///< strength, 0 = off
};

struct ViewSettings {
    double hud_scale = 1.0;                ///< 0.75 to 2.5
    std::int64_t largest_picture = 640;    ///< pixels of the fluoroscopy's side that are computed; more are stretched
    std::string palette = "colour-blind";  ///< of the force bar: "colour-blind" or "high-contrast"
    bool fullscreen = false;
};

struct SoundSettings {
    bool enabled = true;
    double volume = 0.3;      ///< 0 to 1
    bool force_tone = false;  ///< a tone whose pitch follows the force bar
};

struct RunSettings {
    bool record = true;
    std::string folder;        ///< of all recordings; "" = XDG_DATA_HOME/cathlab/runs
    std::string participant;   ///< pseudonym for trial.json; "" = nobody in particular
    std::int64_t threads = 1;  ///< of the step: with one it waits for no other thread
};

struct Settings {
    InputSettings input;
    ViewSettings view;
    SoundSettings sound;
    RunSettings run;
    Bindings bindings = default_bindings();
};

/// The description from which the file, the panel and --print-config are made.
const Table<Settings>& settings_table();

/// XDG_CONFIG_HOME/cathlab/play.toml, or HOME/.config/cathlab/play.toml; "" where there is neither.
std::string settings_path();
/// XDG_DATA_HOME/cathlab, or HOME/.local/share/cathlab; "" where there is neither.
std::string data_home();

/// The file's settings over the defaults.  Throws UserError for what is wrong with it.
Settings read_settings(const std::string& path);

struct LoadedSettings {
    Settings settings;
    std::string message;  ///< "" or what was wrong: then the file was kept aside as PATH.broken and these are defaults
};
/// Never throws for the file's content; a missing file gives the defaults.
LoadedSettings load_settings(const std::string& path);

/// read_settings, or the defaults where there is no file.
Settings read_or_default(const std::string& path);

/// As a TOML file with the meaning of each key.
std::string settings_toml(const Settings& settings);

/// Writes the file, whole or not at all.  Throws UserError.
void save_settings(const Settings& settings, const std::string& path);

}  // namespace cathlab::play
