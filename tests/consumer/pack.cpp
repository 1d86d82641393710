// A program that packs: what it needs of the packer's own libraries is in its flags.
#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/solids.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  innersphere::PackOptions options;
  options.spheres = 20;
  options.overlap_errors = false;
  const bool packed = innersphere::pack(*innersphere::makeBox({1, 1, 1}), options).spheres.size() == 20 &&
                      innersphere::readPacking(argv[1]).spheres.size() == 500;
  try {
    innersphere::readMesh("no such mesh.obj.gz");
  } catch (const innersphere::Error& error) {
    return packed && error.code() == innersphere::ErrorCode::file_not_found ? 0 : 1;
  }
  return 1;
}
