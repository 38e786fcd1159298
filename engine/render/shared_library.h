// A library opened by name at run time, so that the program starts on machines that lack it.
#pragma once

#include <string>

namespace cathlab {

class SharedLibrary {
public:
    /// Throws UserError with the loader's sentence and the Debian package that holds it.
    SharedLibrary(const std::string& file, const std::string& package);
    ~SharedLibrary();
    SharedLibrary(const SharedLibrary&) = delete;
    SharedLibrary& operator=(const SharedLibrary&) = delete;

    template <class Function>
    Function* function(const char* name) const {
        return reinterpret_cast<Function*>(address(name));
    }

private:
    void* address(const char* name) const;  // throws UserError where it is missing
    void* handle_ = nullptr;
    std::string file_;
};

}  // namespace cathlab
