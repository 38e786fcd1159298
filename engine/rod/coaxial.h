// A catheter over a wire as one chain: where they overlap, EI, GJ and EA add and the outer diameter is the catheter's.
//
// The chain runs along the outermost material, so that what rubs on the wall is what moves there: in front the wire's
// own links, as far as the wire is ahead of the catheter's tip, behind them the catheter's links with the wire (or its
// part) as their core.  The last link in front has the length that is left; it grows as the wire comes out.  Eq. 13 of
// [li2025] is followed in its meaning: the axial, the bending and the torsional stiffness each add, K = K_w + K_c.
#pragma once

#include <span>

#include "rod/wire_links.h"

namespace cathlab {

struct Coaxial {
    std::vector<WireLink> links;  ///< arc lengths from the chain's tip
    std::size_t front = 0;        ///< so many of the first are the wire's alone
    double ahead_mm = 0.0;        ///< their length; 0 where the catheter leads
};

/// wire, sleeve: cut by cut_into_links.  turn: angle of the wire's frame about its axis in the catheter's, for the
/// shapes that either has by itself.  A rest of wire shorter than a third of its link is not made a link.
Coaxial compose(std::span<const WireLink> wire, std::span<const WireLink> sleeve, double wire_insertion,
                double sleeve_insertion, double turn);

}  // namespace cathlab
