#include "anatomy/build.h"

namespace cathlab {

AnatomyModel import_anatomy(const ImportedAnatomySpec& spec, const Workers&, const BuildProgress&) {
    validate(spec);
    throw UserError(spec.where, "imported meshes cannot be built by this version");
}

}  // namespace cathlab
