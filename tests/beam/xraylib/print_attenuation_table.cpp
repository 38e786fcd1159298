// Prints engine/beam/attenuation_table.inl from xraylib.
#include <cstdio>

#include "beam/xraylib/attenuation_rows.h"

int main() {
    return std::fputs(cathlab::xraylib::attenuation_table().c_str(), stdout) < 0 ? 1 : 0;
}
