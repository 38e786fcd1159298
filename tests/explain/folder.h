// A data set in a folder of its own that is gone with the object.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>

namespace explain_test {

class Folder {
public:
    Folder(const std::string& toml, const std::string& csv) {
        static std::atomic<int> number{0};
        path_ = std::filesystem::temp_directory_path() /
                ("cathlab_dataset_" + std::to_string(getpid()) + "_" + std::to_string(number++));
        std::filesystem::create_directories(path_);
        std::ofstream(path_ / "dataset.toml") << toml;
        std::ofstream(path_ / "data.csv") << csv;
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string path() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

inline std::string heart_toml(const std::string& beats, const std::string& noise = "0.1") {
    return "format = 1\nkind = \"heart-motion\"\ntitle = \"t\"\nsource = \"s\"\nlicense = \"l\"\ndeclared_effects = "
           "[]\n"
           "sensor_noise = " +
           noise + "\n[setup]\nbeat_times_s = " + beats + "\naxis = [0.0, 0.0, 2.0]\n";
}

}  // namespace explain_test
