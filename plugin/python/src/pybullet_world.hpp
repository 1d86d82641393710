// Finds the world of a PyBullet client, and the bodies in it, by what PyBullet hands to its plug-ins.
#pragma once

#include <string>
#include <utility>

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

namespace innersphere::pybullet {

/// Looks through the command processor's data for the object that is a dynamics world by its RTTI. No offset
/// of a private struct is assumed, and memory is read by a system call that fails where there is none.
/// Returns null if there is no such world; `why` says then what was missing.
btMultiBodyDynamicsWorld* findWorld(void* command_processor, std::string& why);

/// Where findWorld() found a world. That walks through the memory of the process, which takes most of a
/// millisecond; to see that the world is still there takes three words of it.
class WorldPlace {
 public:
  WorldPlace() = default;
  WorldPlace(void* command_processor, btMultiBodyDynamicsWorld& world);

  /// Returns the world if PyBullet still has it there, and it is of the same class; else null. After a reset
  /// this may be another world at the same address. Only while the command processor lives: in its calls.
  btMultiBodyDynamicsWorld* world() const;

 private:
  void* const* data_of_ = nullptr;  ///< the word of the command processor that leads to its data
  void* data_ = nullptr;
  void* const* member_ = nullptr;  ///< the word of these that leads to the world
  btMultiBodyDynamicsWorld* world_ = nullptr;
  const void* table_ = nullptr;  ///< of the virtual functions of its class
};

/// Asks PyBullet where the centre of mass and the principal axes of a body in maximal coordinates are in its
/// base: Bullet does not know it. Returns false if it does not answer as expected; `why` says then how.
bool findInertialFrame(void* command_processor, void* client, int body, const btRigidBody& rigid,
                       btTransform& frame, std::string& why);

/// Returns the collision object of a body's link (-1: its base), or null if there is none.
btCollisionObject* findCollider(btMultiBodyDynamicsWorld& world, int body, int link);

/// Returns the body that a collision object belongs to, and its link (-1: the base), as PyBullet numbers
/// them.
std::pair<int, int> numbersOf(const btCollisionObject& object);

/// Gives a body another shape, and forgets its pairs, whose algorithms were made for the old one.
void swapShape(btMultiBodyDynamicsWorld& world, btCollisionObject& object, btCollisionShape* shape);

}  // namespace innersphere::pybullet
