// The steerable tip that yields under load (effect tip_compliance): a cantilever of one shape.
//
// Point s behind the tip, of a steerable part of length L, goes along with the share (3 x^2 - x^3) / 2, x = 1 - s / L,
// of the tip's way: the shape of a cantilever under a force at its end [gere2008].  The way is compliance x sum of
// share x force over the catheter's rows, solved together with them (TipYield): a force at the tip moves it by
// compliance x force, one further back by as much less as it does a cantilever's end.
#pragma once

#include <vector>

#include "contact/contact_set.h"
#include "step/parts.h"

namespace cathlab {

/// The share of a place so far behind the tip.
double tip_share(const CatheterSpec& spec, double from_tip_mm);

/// Puts the catheter where drive and rail have it, before they move it.
void take_back_yield(CatheterRoute& route);
/// And the other way round.
void give_yield(const CatheterSpec& spec, CatheterRoute& route);

/// The spring of this substep; rigid where no effect asks for one.
TipYield tip_yield(const CatheterSpec& spec, const CatheterRoute& route);

/// Moves the samples of the catheter from where they hold one way of the tip to where they hold another.
void follow_tip(std::vector<DeviceSample>& samples, const Vec3& from, const Vec3& to);

}  // namespace cathlab
