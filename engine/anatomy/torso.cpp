#include "anatomy/torso.h"
namespace cathlab {
std::vector<ContextSolid> make_torso(const ImplicitTree& tree, const Workers& workers) {
    (void)tree;
    (void)workers;
    return {};
}
}  // namespace cathlab
