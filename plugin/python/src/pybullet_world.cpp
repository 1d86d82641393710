#include "pybullet_world.hpp"

#include <dlfcn.h>
#include <malloc.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "innersphere/multi_body_substep_solver.hpp"

namespace innersphere::pybullet {
namespace {

/// Reads memory of this process; returns false where there is none.
bool read(const void* from, void* to, std::size_t bytes) {
  const iovec here{to, bytes};
  const iovec there{const_cast<void*>(from), bytes};
  return process_vm_readv(getpid(), &here, 1, &there, 1, 0) == static_cast<ssize_t>(bytes);
}

const void* wordAt(const void* address) {
  const void* word = nullptr;
  const bool aligned = reinterpret_cast<std::uintptr_t>(address) % alignof(void*) == 0;
  return address != nullptr && aligned && read(address, &word, sizeof word) ? word : nullptr;
}

/// Returns where the shared object begins that an address lies in.
const void* moduleOf(const void* address) {
  Dl_info info{};
  return address != nullptr && dladdr(address, &info) != 0 ? info.dli_fbase : nullptr;
}

/// Returns the mangled name of an object's class if that is one of `module`'s, else nothing. By the Itanium
/// C++ ABI the type_info is in the slot before the first virtual function, and its second word is the name.
std::string_view classOf(const void* object, const void* module) {
  const void* table = wordAt(object);
  if (table == nullptr || moduleOf(table) != module) return {};
  const void* info = wordAt(static_cast<const void* const*>(table) - 1);
  if (info == nullptr || moduleOf(info) != module) return {};
  const auto* name = static_cast<const char*>(wordAt(static_cast<const void* const*>(info) + 1));
  if (name == nullptr || moduleOf(name) != module) return {};
  return *name == '*' ? name + 1 : name;
}

constexpr std::size_t kMostBytes = 1 << 19;  // of the command processor's data, which are looked through

bool endsWith(std::string_view name, std::string_view end) {
  return name.size() >= end.size() && name.substr(name.size() - end.size()) == end;
}

/// Checks the layout of the world's class by what its members are. The solver may be ours.
bool hasKnownMembers(btMultiBodyDynamicsWorld& world, const void* module) {
  const btConstraintSolver* solver = world.getConstraintSolver();
  const bool ours = dynamic_cast<const MultiBodySubstepSolver*>(solver) != nullptr;
  return classOf(world.getDispatcher(), module) == "21btCollisionDispatcher" &&
         endsWith(classOf(world.getBroadphase(), module), "Broadphase") &&
         (ours || endsWith(classOf(solver, module), "Solver")) &&
         endsWith(classOf(world.getPairCache(), module), "PairCache");
}

/// Returns a function of PyBullet's C interface, or null.
template <typename Function>
Function* function(void* library, const char* name) {
  return reinterpret_cast<Function*>(dlsym(library, name));
}

/// The first member of the command processor, after the table of its class, leads to its data.
void* const* dataOf(void* command_processor) {
  return static_cast<void* const*>(command_processor) + 1;
}

}  // namespace

btMultiBodyDynamicsWorld* findWorld(void* command_processor, std::string& why) {
  const void* module = moduleOf(wordAt(command_processor));
  if (module == nullptr || classOf(command_processor, module) != "29PhysicsServerCommandProcessor") {
    why = "its command processor is of an unknown class";
    return nullptr;
  }
  void* data = const_cast<void*>(wordAt(dataOf(command_processor)));  // a block of some kilobytes
  void* first = nullptr;
  const std::size_t bytes = data != nullptr && read(data, &first, sizeof first)
                                ? std::min(malloc_usable_size(data), kMostBytes)
                                : 0;
  std::vector<void*> members(bytes / sizeof(void*));
  if (members.empty() || !read(data, members.data(), members.size() * sizeof(void*))) {
    why = "the command processor's data cannot be read";
    return nullptr;
  }
  btMultiBodyDynamicsWorld* found = nullptr;
  for (void* member : members) {
    if (!endsWith(classOf(member, module), "DynamicsWorld")) continue;
    auto* world = dynamic_cast<btMultiBodyDynamicsWorld*>(static_cast<btDynamicsWorld*>(member));
    if (world == nullptr || world == found) continue;
    if (found != nullptr) {
      why = "it holds more than one world";
      return nullptr;
    }
    found = world;
  }
  if (found == nullptr) {
    why = "it holds no btMultiBodyDynamicsWorld";
  } else if (!hasKnownMembers(*found, module)) {
    why = "the members of its world are not where Bullet 3.24 to 3.26 has them";
    found = nullptr;
  }
  return found;
}

WorldPlace::WorldPlace(void* command_processor, btMultiBodyDynamicsWorld& world)
    : data_of_(dataOf(command_processor)), data_(*data_of_) {
  void* const* members = static_cast<void* const*>(data_);
  const std::size_t count = std::min(malloc_usable_size(data_), kMostBytes) / sizeof(void*);
  void* const wanted = static_cast<btDynamicsWorld*>(&world);
  // Of several words only one may be kept up to date.
  if (std::count(members, members + count, wanted) != 1) return;
  member_ = std::find(members, members + count, wanted);
  world_ = &world;
  table_ = *reinterpret_cast<const void* const*>(&world);
}

btMultiBodyDynamicsWorld* WorldPlace::world() const {
  if (member_ == nullptr || *data_of_ != data_ || *member_ != static_cast<btDynamicsWorld*>(world_))
    return nullptr;
  return *reinterpret_cast<const void* const*>(world_) == table_ ? world_ : nullptr;
}

bool findInertialFrame(void* command_processor, void* client, int body, const btRigidBody& rigid,
                       btTransform& frame, std::string& why) {
  Dl_info info{};
  const void* table = wordAt(command_processor);
  void* library = table != nullptr && dladdr(table, &info) != 0
                      ? dlopen(info.dli_fname, RTLD_LAZY | RTLD_NOLOAD)
                      : nullptr;
  if (library == nullptr || client == nullptr) {
    why = "it has no interface for plug-ins";
    return false;
  }
  // PyBullet stays loaded without this.
  dlclose(library);
  const auto request = function<void*(void*, int)>(library, "b3RequestActualStateCommandInit");
  const auto submit = function<void*(void*, void*)>(library, "b3SubmitClientCommandAndWaitStatus");
  const auto read_state =
      function<int(void*, int*, int*, int*, const double**, const double**, const double**, const double**)>(
          library, "b3GetStatusActualState");
  if (request == nullptr || submit == nullptr || read_state == nullptr) {
    why = "it has no functions that tell the state of a body";
    return false;
  }
  int told = -1, positions = 0;
  const double *f = nullptr, *at = nullptr;
  void* status = submit(client, request(client, body));
  if (status == nullptr || !read_state(status, &told, &positions, nullptr, &f, &at, nullptr, nullptr) ||
      told != body || positions < 7 || f == nullptr || at == nullptr) {
    why = "it does not tell the state of body " + std::to_string(body);
    return false;
  }
  // Before the frame is believed, what stands beside it has to be what Bullet has.
  const btTransform& pose = rigid.getWorldTransform();
  const btQuaternion turn(f[3], f[4], f[5], f[6]);
  const btScalar off = (btVector3(at[0], at[1], at[2]) - pose.getOrigin()).length();
  const btScalar same_turn = btFabs(btQuaternion(at[3], at[4], at[5], at[6]).dot(pose.getRotation()));
  if (!(off <= 1e-9 * (1 + pose.getOrigin().length())) || !(btFabs(same_turn - 1) < 1e-6) ||
      !(btFabs(turn.length2() - 1) < 1e-6)) {
    why = "the state that it tells of body " + std::to_string(body) + " is not that of its world";
    return false;
  }
  frame = btTransform(turn, btVector3(f[0], f[1], f[2]));
  return true;
}

std::pair<int, int> numbersOf(const btCollisionObject& object) {
  if (const auto* collider = btMultiBodyLinkCollider::upcast(&object))
    return {collider->m_multiBody->getUserIndex2(), collider->m_link};
  return {object.getUserIndex2(), -1};
}

btCollisionObject* findCollider(btMultiBodyDynamicsWorld& world, int body, int link) {
  for (int i = 0; i < world.getNumCollisionObjects(); ++i) {
    btCollisionObject* object = world.getCollisionObjectArray()[i];
    if (numbersOf(*object) == std::pair(body, link)) return object;
  }
  return nullptr;
}

void swapShape(btMultiBodyDynamicsWorld& world, btCollisionObject& object, btCollisionShape* shape) {
  if (btBroadphaseProxy* proxy = object.getBroadphaseHandle())
    world.getPairCache()->cleanProxyFromPairs(proxy, world.getDispatcher());
  object.setCollisionShape(shape);
  world.updateSingleAabb(&object);
  object.activate(true);
}

}  // namespace innersphere::pybullet
