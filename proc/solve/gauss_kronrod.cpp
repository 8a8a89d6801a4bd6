#include "proc/solve/gauss_kronrod.h"

#include <cstddef>

namespace gonio::proc {
namespace {

/// Of the rules on [-1, 1], from the outermost node to the middle.
struct HalfRule {
    double at, kronrod, gauss;
};
constexpr std::array<HalfRule, 8> kHalf{{
    {0.991455371120812639206854697526, 0.022935322010529224963732008059, 0},
    {0.949107912342758524526189684048,
     0.063092092629978553290700663189,
     0.129484966168869693270611432679},
    {0.864864423359769072789712788641, 0.104790010322250183839876322542, 0},
    {0.741531185599394439863864773281,
     0.140653259715525918745189590510,
     0.279705391489276667901467771424},
    {0.586087235467691130294144838259, 0.169004726639267902826583426599, 0},
    {0.405845151377397166906606412077,
     0.190350578064785409913256402421,
     0.381830050505118944950369775489},
    {0.207784955007898467600689403773, 0.204432940075298892414161999235, 0},
    {0, 0.209482141084727828012999174892, 0.417959183673469387755102040816},
}};

std::array<KronrodNode, 15> onUnit() {
    std::array<KronrodNode, 15> nodes;
    for (std::size_t i = 0; i < kHalf.size(); ++i) {
        const HalfRule& half = kHalf[i];
        nodes[i] = {(1 - half.at) / 2, half.kronrod / 2, half.gauss / 2};
        nodes[nodes.size() - 1 - i] = {(1 + half.at) / 2, half.kronrod / 2, half.gauss / 2};
    }
    return nodes;
}

}  // namespace

const std::array<KronrodNode, 15>& gaussKronrod() {
    static const auto nodes = onUnit();
    return nodes;
}

}  // namespace gonio::proc
