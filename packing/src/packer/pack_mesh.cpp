#include "innersphere/pack_mesh.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "packer/pack_cache.hpp"
#include "packer/pack_options.hpp"

namespace innersphere {
namespace {

Packing packAnew(const Mesh& mesh, const std::string& name, const PackMeshOptions& options,
                 const Progress& progress) {
  MeshOptions mesh_options;
  mesh_options.repair = options.repair;
  MeshReport report;
  const std::unique_ptr<Solid> solid = makeSolid(mesh, name, mesh_options, &report);
  Packing packing = pack(*solid, options.pack, progress);
  packing.warnings.insert(packing.warnings.begin(), report.notes.begin(), report.notes.end());
  return packing;
}

std::string optionsText(const PackMeshOptions& options) {
  return commandLine(options.pack) + (options.repair ? " --repair" : "") +
         (options.pack.overlap_errors ? "" : " without overlap errors");
}

}  // namespace

PackOptions startUpOptions(std::size_t spheres) {
  PackOptions options;
  options.spheres = spheres;
  options.overlap_errors = false;
  return options;
}

std::string defaultCacheFolder() {
  const auto within = [](const char* variable, const char* folder) -> std::string {
    const char* value = std::getenv(variable);
    return value == nullptr || *value == 0 ? "" : (std::filesystem::path(value) / folder).string();
  };
  const std::string folder = within("XDG_CACHE_HOME", "innersphere");
  return folder.empty() ? within("HOME", ".cache/innersphere") : folder;
}

Packing packMesh(const Mesh& mesh, const std::string& name, const PackMeshOptions& options,
                 const Progress& progress) {
  if (options.cache_folder.empty()) return packAnew(mesh, name, options, progress);
  const auto notice = [&](const std::string& message) {
    if (options.notice) return options.notice(message);
    std::fprintf(stderr, "InnerSphere: %s\n", message.c_str());
  };
  const PackCache cache(options.cache_folder, PackCache::keyOf(mesh, optionsText(options)));
  try {
    if (std::optional<Packing> kept = cache.read()) {
      kept->provenance.source = name;
      return std::move(*kept);
    }
  } catch (const Error& error) {
    notice("The cached packing of \"" + name + "\" is packed anew: " + error.what() + ".");
  }
  Packing packing = packAnew(mesh, name, options, progress);
  try {
    cache.write(packing);
  } catch (const Error& error) {
    notice("The packing of \"" + name + "\" is not kept for the next start: " + error.what() + ".");
  }
  return packing;
}

}  // namespace innersphere
