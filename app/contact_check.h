// A wall-contact data set beside the wall that it describes.
#pragma once

#include <string>

#include "context.h"

namespace cathlab {

struct ContactCheck {
    std::string folder;  ///< of the data set
    double particle_spacing_mm = 2.5;
    int threads = 1;
};

/// Prints the contacts one by one and the figures over all samples.  Throws UserError.
void check_contacts(const ContactCheck& options, AppContext& context);

}  // namespace cathlab
