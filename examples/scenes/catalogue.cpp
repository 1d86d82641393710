#include "catalogue.hpp"

#include "scene.hpp"

namespace innersphere::demo {

const std::vector<Scene>& scenes() {
  constexpr double k240 = 1.0 / 240;
  static const std::vector<Scene> all = {
      {"pile", "Two dozen mixed solids fall into a tray and come to rest on each other.",
       "Contacts of any solid with any other, many at once, that neither leak nor shake.", buildPile, 12,
       k240, 1000, 0, true},
      {"large-pile", "A hundred mixed solids fall into a tray and come to rest on each other.",
       "The same with so many bodies that pairs come and go all the time.", buildLargePile, 14, k240, 500, 0,
       true},
      {"rest", "Box, ball, torus, cylinder and gear lie on a plane.",
       "Contact is at the solids' own surfaces, not at those of their spheres.", buildRest, 3},
      {"soft", "A box and a ball sink into a plane under a given stiffness.",
       "Overlap volumes and the forces that follow from them have their units and their size.", buildSoft, 4,
       k240, 16000, 5e5},
      {"drop", "A torus falls on its side and comes to lie flat.",
       "Contacts that change quickly take energy and never add any.", buildDrop, 8},
      {"bounce", "Balls, a box and a torus fall on a plane and bounce, with and without loss.",
       "Bullet's restitution acts once an impact, however many points carry it.", buildBounce, 1.5},
      {"slide", "Boxes on an incline, below, at and above the friction angle.",
       "Friction is Coulomb's, on Bullet's shapes and on packings.", buildSlide, 1},
      {"roll", "A ball and a cylinder slide on a plane until friction makes them roll.",
       "Friction acts at the point of contact, and the inertia is the solid's own.", buildRoll, 1},
      {"flip", "A box spins about its middle axis and flips again and again.",
       "Bodies have the principal moments of their solid.", buildFlip, 5, 1.0 / 4000},
      {"torsion", "A torus and a disc spin flat on a plane until friction stops them.",
       "Points of a contact are spread as its pressure is.", buildTorsion, 0.7},
      {"cradle", "Newton's cradle: one ball hits four, and the last one leaves.",
       "Impacts hand momentum on from body to body.", buildCradle, 2.5, 1.0 / 2000},
      {"collisions", "Pairs of balls collide in free space, head-on and glancing.",
       "Impulses are along the normal and as large as momentum and restitution ask for.", buildCollisions, 2},
      {"tumble", "Two brackets collide and tumble on in free space.",
       "Forces are equal and opposite and act at one point: momenta are kept.", buildTumble, 2},
      {"stack", "Ten boxes, each a packing, stand on each other.",
       "Flat contacts carry a load without tilting, creeping or shaking.", buildStack, 30},
      {"card-house", "Three brackets and a plank: a card-house of two storeys.",
       "Edges carry as well as faces do, with next to no area.", buildCardHouse, 10},
      {"mass-ratios", "A box on a box, one to a thousand times as heavy.",
       "Contacts are stiff enough for what lies on them.", buildMassRatios, 5},
      {"chain-hang", "Ten interlocked rings hang from the first one, which is held.",
       "Contact of rings, where two points are far from any flat face, stays where it is.", buildChainHang},
      {"chain-swing", "Ten interlocked rings hang from the first one, which is held, and swing.",
       "The same while the contact moves along the rings.", buildChainSwing},
      {"chain-heavy", "The same chain with a last ring of a hundred times the mass.",
       "Light bodies between heavy ones do not give way.", buildChainHeavy},
      {"bowls", "Five bowls settle in each other.",
       "Curved surfaces that nearly fit, with contact all around.", buildBowls, 5, k240, 2000},
      {"nut", "A nut without friction turns down a bolt under its weight.",
       "Threads: contact along many turns at once, with normals that drive the turn.", buildNut, 4, k240,
       4000},
      {"nut-held", "A nut with friction stays on its bolt.",
       "Friction holds on slopes that are below the friction angle.", buildNutHeld, 4, k240, 4000},
      {"gears", "A gear of 16 teeth drives one of 24.", "Teeth mesh without slipping, skipping or jamming.",
       buildGears, 5, k240, 2000},
      {"peg", "A peg falls into a hole that is one percent wider.",
       "Clearances that are far smaller than the spheres stay open.", buildPeg, 2, k240, 2000},
      {"maze", "A ball rolls through a maze.", "Walls have no holes and corners do not catch.", buildMaze, 14,
       k240, 2000},
      {"chazelle", "Two Chazelle polyhedra, pushed into each other, come apart and come to rest.",
       "Overlaps of solids with hardly any inside are undone gently.", buildChazelle, 5, k240, 4000},
  };
  return all;
}

}  // namespace innersphere::demo
