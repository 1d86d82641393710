// The scenes' functions; scenes() lists them.
#pragma once

namespace innersphere::demo {

class SceneWorld;
struct SceneOptions;

using BuildScene = void(SceneWorld& world, const SceneOptions& options);

// With a closed form.
BuildScene buildRest, buildSoft, buildBounce, buildSlide, buildRoll, buildFlip, buildTorsion, buildCradle,
    buildCollisions, buildTumble, buildStack, buildCardHouse, buildMassRatios, buildDrop;

// That need non-convex contact.
BuildScene buildChainHang, buildChainSwing, buildChainHeavy, buildBowls, buildNut, buildNutHeld, buildGears,
    buildPeg, buildMaze, buildPile, buildLargePile, buildChazelle;

}  // namespace innersphere::demo
