// What every subcommand knows: where the program's data lie, and how to end.
#pragma once

#include <csignal>
#include <string>

namespace cathlab {

struct AppContext {
    std::string data_root;     ///< holds assets/ and scenes/
    std::string cache_folder;  ///< for built anatomies; "" = none
    std::string command_line;  ///< as a shell would take it, for reports
    int exit_code = 0;         ///< 0 done, 1 the work failed
};

/// CATHLAB_DATA_DIR, or the source folder that the program was built from, or share/cathlab beside the executable's
/// folder, or that folder itself: the first that holds assets/.  Throws UserError where none does.
std::string find_data_root();

/// CATHLAB_CACHE_DIR, or XDG_CACHE_HOME/cathlab, or HOME/.cache/cathlab, or "".
std::string find_cache_folder();

/// A path as it is best written into a manifest: relative to the data root where it lies inside, else absolute.
std::string path_for_manifest(const std::string& path, const std::string& data_root);

/// A command line with "'" around what a shell would not take as it stands; of the program its name alone.
std::string shell_command(int argc, const char* const* argv);

/// From now on Ctrl-C (SIGINT) and SIGTERM set a flag instead of ending the program; a second one ends it.
void catch_stop_signals();
/// Whether one came.
bool stop_wanted();

}  // namespace cathlab
