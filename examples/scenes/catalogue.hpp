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

// What an outside user tried.
BuildScene buildArch, buildArchThin, buildDominoes, buildRingPeg, buildRingCylinder, buildHalfPipe,
    buildHalfPipeMesh, buildTSlot, buildGripper, buildGripperMotor, buildCarabiner, buildChainRest,
    buildDrops, buildGearBox, buildGearPlane, buildGearMesh, buildPile50, buildScanBin;

}  // namespace innersphere::demo
