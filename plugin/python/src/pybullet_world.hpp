// Finds the world of a PyBullet client, and the bodies in it, by what PyBullet hands to its plug-ins.
#pragma once

#include <string>

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

namespace innersphere::pybullet {

/// Looks through the command processor's data for the object that is a dynamics world by its RTTI. No offset
/// of a private struct is assumed, and memory is read by a system call that fails where there is none.
/// Returns null if there is no such world; `why` says then what was missing.
btMultiBodyDynamicsWorld* findWorld(void* command_processor, std::string& why);

/// Returns the collision object of a body's link (-1: its base), or null if there is none.
btCollisionObject* findCollider(btMultiBodyDynamicsWorld& world, int body, int link);

/// Returns the body that a collision object belongs to, and its link (-1: the base), as PyBullet numbers
/// them.
std::pair<int, int> numbersOf(const btCollisionObject& object);

/// Gives a body another shape, and forgets its pairs, whose algorithms were made for the old one.
void swapShape(btMultiBodyDynamicsWorld& world, btCollisionObject& object, btCollisionShape* shape);

}  // namespace innersphere::pybullet
