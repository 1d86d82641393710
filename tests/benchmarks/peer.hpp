// Other libraries' collision of two triangle meshes, to compare with.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "innersphere/geometry.hpp"
#include "innersphere/placement.hpp"

namespace innersphere::benchmarks {

/// A mesh and a moved copy of it.
class Peer {
 public:
  virtual ~Peer() = default;
  virtual std::string name() const = 0;
  /// The number of contacts it finds; all that it can give are asked for.
  virtual std::size_t contacts(const Placement& copy) = 0;
};

/// Bullet's triangle meshes that move.
std::unique_ptr<Peer> makeGImpactPeer(const Mesh& mesh);

/// The Flexible Collision Library. Null where the benchmarks were built without it.
std::unique_ptr<Peer> makeFclPeer(const Mesh& mesh);

/// Those that there are.
inline std::vector<std::unique_ptr<Peer>> makePeers(const Mesh& mesh) {
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(makeGImpactPeer(mesh));
  if (auto fcl = makeFclPeer(mesh)) peers.push_back(std::move(fcl));
  return peers;
}

}  // namespace innersphere::benchmarks
