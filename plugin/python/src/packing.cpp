// Packings: made from meshes, read, written, and seen as numpy arrays.
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>

#include "bindings.hpp"
#include "innersphere/check.hpp"
#include "innersphere/clump_solid.hpp"
#include "innersphere/cover_solid.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/pack_mesh.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/solids.hpp"
#include "structured.hpp"

namespace innersphere::python {
namespace {

using namespace nb::literals;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

constexpr std::pair<const char*, SphereOrder> kOrders[] = {{"radius", SphereOrder::radius},
                                                           {"coverage", SphereOrder::coverage}};

PyObject* coverage_type = nullptr;  // it lives as long as the module

SharedPacking share(Packing&& packing) {
  const auto count = static_cast<std::uint32_t>(packing.spheres.size());
  return {std::make_shared<CollisionModel>(std::make_shared<const Packing>(std::move(packing))), count};
}

/// Calls a Python function on progress, which may be None, and looks for Ctrl-C. What Python raises waits
/// here until the packer has returned.
class PythonProgress {
 public:
  explicit PythonProgress(nb::object callback) : callback_(std::move(callback)) {}

  bool operator()(const char* stage, double fraction) {
    const nb::gil_scoped_acquire acquire;
    try {
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      return callback_.is_none() || callback_(stage, fraction).ptr() != Py_False;
    } catch (...) {
      raised_ = std::current_exception();
      return false;
    }
  }

  /// Does long work without the GIL: `work` gets this for its progress. Throws what Python raised, and what
  /// `work` throws.
  template <typename Work>
  auto run(const Work& work) {
    try {
      const nb::gil_scoped_release release;
      return work(std::ref(*this));
    } catch (const Error& error) {
      if (error.code() == ErrorCode::cancelled && raised_) std::rethrow_exception(raised_);
      throw;
    }
  }

 private:
  nb::object callback_;
  std::exception_ptr raised_;
};

using Vertices = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Faces = nb::ndarray<const std::int64_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

Mesh meshOf(const Vertices& vertices, const Faces& faces) {
  const std::int64_t count = static_cast<std::int64_t>(vertices.shape(0));
  for (std::size_t i = 0; i < 3 * faces.shape(0); ++i) {
    const std::int64_t index = faces.data()[i];
    if (index < 0 || index >= count) {
      throw Error(ErrorCode::bad_argument, "face " + std::to_string(i / 3) + " names vertex " +
                                               std::to_string(index) + "; there are " +
                                               std::to_string(count));
    }
  }
  return meshFrom(vertices.data(), vertices.shape(0), faces.data(), faces.shape(0));
}

/// Vertices and faces of a mesh.
nb::tuple surfaceOf(const Mesh& mesh) {
  auto* vertices = new std::vector<Vec3d>(mesh.vertices);
  auto* faces = new std::vector<std::array<std::uint32_t, 3>>(mesh.triangles.begin(), mesh.triangles.end());
  const nb::capsule vertex_owner(vertices,
                                 [](void* p) noexcept { delete static_cast<std::vector<Vec3d>*>(p); });
  const nb::capsule face_owner(
      faces, [](void* p) noexcept { delete static_cast<std::vector<std::array<std::uint32_t, 3>>*>(p); });
  static_assert(sizeof(Vec3d) == 3 * sizeof(double));
  return nb::make_tuple(
      nb::ndarray<nb::numpy, double>(reinterpret_cast<double*>(vertices->data()), {vertices->size(), 3},
                                     vertex_owner),
      nb::ndarray<nb::numpy, std::uint32_t>(faces->data()->data(), {faces->size(), 3}, face_owner));
}

/// Vertices and faces of a mesh after it was judged and mended as for packing.
nb::tuple surfaceOfMesh(const Mesh& mesh, const std::string& name, bool repair) {
  const std::unique_ptr<Solid> solid = [&] {
    const nb::gil_scoped_release release;
    MeshOptions options;
    options.repair = repair;
    return makeSolid(mesh, name, options);
  }();
  return surfaceOf(solid->surface());
}

/// Vertices and faces of each body of a surface, with its cavities.
nb::list bodiesOf(const Vertices& vertices, const Faces& faces) {
  const std::vector<Mesh> bodies = [&] {
    const Mesh mesh = meshOf(vertices, faces);
    const nb::gil_scoped_release release;
    return splitBodies(mesh);
  }();
  nb::list found;
  for (const Mesh& body : bodies) found.append(surfaceOf(body));
  return found;
}

void warn(const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) {
    if (PyErr_WarnEx(PyExc_RuntimeWarning, sentence.c_str(), 1) != 0) throw nb::python_error();
  }
}

Mesh readScaledMesh(const std::filesystem::path& path, double scale) {
  std::vector<std::string> notes;
  Mesh mesh = [&] {
    const nb::gil_scoped_release release;
    MeshOptions options;
    options.scale = scale;
    return readMesh(path.string(), options, &notes);
  }();
  for (std::string& note : notes) note = path.string() + ": " + note;
  warn(notes);
  return mesh;
}

/// Multiplies coordinates by a factor for each axis. Triangles of a mirror image wind the other way round.
void stretch(Mesh& mesh, const std::array<double, 3>& factors) {
  for (Vec3d& vertex : mesh.vertices) {
    for (int k = 0; k < 3; ++k) vertex[k] *= factors[k];
  }
  if (factors[0] * factors[1] * factors[2] > 0) return;
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

std::size_t natural(const char* name, std::int64_t value) {
  if (value < 0)
    throw Error(ErrorCode::bad_argument,
                std::string(name) + " is " + std::to_string(value) + "; it must not be negative");
  return static_cast<std::size_t>(value);
}

SharedPacking packWith(const Mesh& mesh, const std::string& name, std::int64_t spheres, double min_radius,
                       double density, double gap, const std::string& order, double delta,
                       bool overlap_errors, int threads, bool repair, const std::filesystem::path& cache,
                       nb::object progress) {
  PackMeshOptions options;
  options.pack.spheres = natural("spheres", spheres);
  options.pack.min_radius = min_radius;
  options.pack.density = density;
  options.pack.gap = gap;
  options.pack.order = parseWord("order", order, kOrders);
  options.pack.delta = delta;
  options.pack.overlap_errors = overlap_errors;
  options.pack.threads = threads;
  options.repair = repair;
  options.cache_folder = cache.string();
  std::vector<std::string> notices;
  options.notice = [&](const std::string& message) { notices.push_back(message); };
  SharedPacking result = PythonProgress(std::move(progress)).run([&](const Progress& told) {
    return share(packMesh(mesh, name, options, told));
  });
  warn(notices);
  return result;
}

/// Numbers that Python may change, in an array of its own.
template <typename T>
nb::object copyOf(const T& numbers, std::initializer_list<std::size_t> shape) {
  double* data = new double[numbers.end() - numbers.begin()];
  std::copy(numbers.begin(), numbers.end(), data);
  const nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<double*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, double>(data, shape, owner));
}

/// What is needed of a packing to cover its solid.
Packing spheresAndSurface(const SharedPacking& self) {
  Packing first;
  first.origin = self.packing().origin;
  first.spheres.assign(self.packing().spheres.begin(), self.packing().spheres.begin() + self.count);
  first.order = self.packing().order;
  first.surface = self.packing().surface;
  first.provenance = self.packing().provenance;
  return first;
}

/// Spheres in the solid's own coordinates (n, 4), and their largest overhang.
nb::tuple spheresOf(const Covering& covering) {
  std::vector<double> numbers;
  for (const Sphere& s : covering.spheres) {
    for (int k = 0; k < 3; ++k) numbers.push_back(covering.origin[k] + (&s.x)[k]);
    numbers.push_back(s.radius);
  }
  return nb::make_tuple(copyOf(numbers, {covering.spheres.size(), 4}), covering.overhang_max);
}

nb::tuple coverPacking(const SharedPacking& self, double resolution) {
  CoverOptions options;
  options.resolution = resolution;
  return spheresOf(PythonProgress(nb::none()).run([&](const Progress& told) {
    return coverSurface(spheresAndSurface(self), options, told);
  }));
}

nb::tuple clumpOfPacking(const SharedPacking& self, double outside_weight) {
  ClumpOptions options;
  options.spheres = self.count;
  options.outside_weight = outside_weight;
  return spheresOf(PythonProgress(nb::none()).run([&](const Progress& told) {
    return clumpSurface(spheresAndSurface(self), options, told);
  }));
}

SharedPacking readShared(const std::filesystem::path& path) {
  const nb::gil_scoped_release release;
  return share(readPacking(path.string()));
}

void save(const SharedPacking& self, const std::filesystem::path& path, bool overwrite) {
  if (!self.whole()) {
    throw Error(
        ErrorCode::bad_argument,
        "a slice of a packing cannot be saved; save the whole packing, and slice what read() returns");
  }
  const nb::gil_scoped_release release;
  writePacking(self.packing(), path.string(), overwrite);
}

SharedPacking slice(const SharedPacking& self, nb::handle index) {
  if (!PySlice_Check(index.ptr()))
    throw nb::type_error("packings take slices [:n] only; a single sphere is a row of .spheres");
  Py_ssize_t start = 0, stop = 0, step = 0;
  if (PySlice_Unpack(index.ptr(), &start, &stop, &step) != 0) throw nb::python_error();
  const Py_ssize_t count = PySlice_AdjustIndices(self.count, &start, &stop, step);
  if (start != 0 || step != 1 || count == 0)
    throw nb::value_error("a slice of a packing is its first spheres: [:n], with at least one of them");
  return {self.model, static_cast<std::uint32_t>(count)};
}

/// Rows of `width` numbers that belong to `owner`, read-only.
template <typename T>
nb::object rows(const T* first, std::size_t count, std::size_t width, nb::handle owner) {
  return nb::cast(nb::ndarray<nb::numpy, const T, nb::ndim<2>>(first, {count, width}, owner));
}

double densityOf(const SharedPacking& self) {
  if (self.whole()) return self.packing().quality.density;
  double cubes = 0;
  for (std::uint32_t i = 0; i < self.count; ++i)
    cubes += std::pow(double(self.packing().spheres[i].radius), 3);
  return cubes * 4 / 3 * std::acos(-1.0) / self.packing().solid.volume;
}

nb::dict qualityOf(const SharedPacking& self) {
  const Quality& quality = self.packing().quality;
  const Certificate& certificate = self.packing().certificate;
  const Coverage* coverage = coverageOf(self.packing(), self.count);
  const auto gap = [&](double of_whole, double Coverage::*of_slice) {
    if (self.whole()) return of_whole;
    return coverage != nullptr && coverage->count == self.count ? coverage->*of_slice : kUnknown;
  };
  const auto of_whole = [&](double value) { return self.whole() ? value : kUnknown; };
  nb::dict result;
  result["density"] = densityOf(self);
  result["gap_mean"] = gap(quality.gap_mean, &Coverage::mean);
  result["gap_p95"] = gap(quality.gap_p95, &Coverage::p95);
  result["gap_max"] = gap(quality.gap_max, &Coverage::max);
  result["largest_missing_radius"] =
      of_whole(certificate.delta > 0 ? certificate.largest_missing_radius : kUnknown);
  return result;
}

nb::object coverageRows(const SharedPacking& self) {
  std::vector<Coverage> rows;
  for (const Coverage& one : self.packing().coverage) {
    if (one.count <= self.count) rows.push_back(one);
  }
  return structuredArray(std::move(rows), coverage_type);
}

nb::tuple overlapErrorsOf(const SharedPacking& self) {
  nb::list rows;
  const OverlapErrors& errors = self.packing().overlap_errors;
  const double size = std::cbrt(self.packing().solid.volume);
  const auto means = [size](const OverlapErrors::Estimate& estimate) {
    nb::list all;
    for (const OverlapErrors::AtDepth& at : estimate.copies)
      all.append(nb::make_tuple(size * at.depth, at.error.mean));
    return all;
  };
  for (const OverlapErrors::Prefix& prefix : errors.prefixes) {
    if (prefix.count <= self.count)
      rows.append(nb::make_tuple(prefix.count, means(prefix.raw), means(prefix.volume_true)));
  }
  return nb::tuple(rows);
}

nb::dict provenanceOf(const SharedPacking& self) {
  const Provenance& from = self.packing().provenance;
  nb::dict result;
  result["source"] = from.source;
  result["source_hash"] = from.source_hash;
  result["options"] = from.options;
  result["version"] = from.version;
  return result;
}

std::string describe(const SharedPacking& self) {
  char text[120];
  std::snprintf(text, sizeof text, "<innersphere.Packing: %u spheres, %.3g of %.3g m^3>", self.count,
                densityOf(self), self.packing().solid.volume);
  return text;
}

std::size_t hashOf(const SharedPacking& self) {
  const auto* bytes = reinterpret_cast<const char*>(self.packing().spheres.data());
  return std::hash<std::string_view>()({bytes, self.count * sizeof(Sphere)});
}

// By their files, which hold every field, and in which nan is equal to nan.
bool equal(const SharedPacking& a, const SharedPacking& b) {
  if (a.count != b.count) return false;
  if (a.model == b.model) return true;
  const nb::gil_scoped_release release;
  return hashOf(a) == hashOf(b) && encodePacking(a.packing()) == encodePacking(b.packing());
}

nb::tuple state(const SharedPacking& self) {
  std::string bytes;
  {
    const nb::gil_scoped_release release;
    bytes = encodePacking(self.packing());
  }
  return nb::make_tuple(nb::bytes(bytes.data(), bytes.size()), self.count);
}

void restore(SharedPacking& self, const std::pair<nb::bytes, std::uint32_t>& state) {
  SharedPacking read = share(decodePacking(std::string(state.first.c_str(), state.first.size())));
  if (state.second == 0 || state.second > read.count)
    throw Error(ErrorCode::bad_format, "the pickle of a packing names more spheres than it holds");
  read.count = state.second;
  new (&self) SharedPacking(std::move(read));
}

}  // namespace

void bindPacking(nb::module_& module) {
  nb::object coverage =
      structuredType(sizeof(Coverage), {{"count", "<u4", offsetIn(&Coverage::count)},
                                        {"mean", "<f8", offsetIn(&Coverage::mean)},
                                        {"p95", "<f8", offsetIn(&Coverage::p95)},
                                        {"max", "<f8", offsetIn(&Coverage::max)},
                                        {"farthest", "(3,)<f8", offsetIn(&Coverage::farthest)},
                                        {"uncovered", "<f8", offsetIn(&Coverage::uncovered)}});
  module.attr("coverage_dtype") = coverage;
  coverage_type = coverage.release().ptr();

  nb::class_<SharedPacking>(module, "Packing",
                            R"(Spheres inside a solid that do not overlap, the most important first.

Made by pack() or read(). It never changes, and can be shared by threads and pickled. All places are in the
packing's own frame: x_solid = origin + x. Lengths are in metres.

Packings are equal if all that they tell is, to the bit: a pickle and a file give an equal one back. Equal ones have the
same hash.

``packing[:n]`` are the first n spheres: a coarser packing of the same solid. It shares memory with the whole.)")
      .def_prop_ro(
          "spheres",
          [](nb::handle_t<SharedPacking> self) {
            const auto& p = nb::cast<const SharedPacking&>(self);
            return rows(&p.packing().spheres[0].x, p.count, 4, self);
          },
          nb::sig("def spheres(self) -> numpy.typing.NDArray[numpy.float32]"),
          "Centre x y z and radius of each sphere [m]: (n, 4) float32, read-only, no copy.")
      .def_prop_ro(
          "origin", [](const SharedPacking& p) { return copyOf(p.packing().origin, {3}); },
          nb::sig("def origin(self) -> numpy.typing.NDArray[numpy.float64]"),
          "Where the packing's frame is in that of the solid [m]: (3,) float64. Zero unless the solid is "
          "farther than eight of its sizes from its own origin. Poses are always those of the solid.")
      .def_prop_ro(
          "vertices",
          [](nb::handle_t<SharedPacking> self) {
            const Surface& surface = nb::cast<const SharedPacking&>(self).packing().surface;
            return rows(reinterpret_cast<const float*>(surface.vertices.data()), surface.vertices.size(), 3,
                        self);
          },
          nb::sig("def vertices(self) -> numpy.typing.NDArray[numpy.float32]"),
          "Vertices of the solid's surface [m]: (n, 3) float32, read-only, no copy. Empty if the surface is "
          "unknown.")
      .def_prop_ro(
          "faces",
          [](nb::handle_t<SharedPacking> self) {
            const Surface& surface = nb::cast<const SharedPacking&>(self).packing().surface;
            return rows(reinterpret_cast<const std::uint32_t*>(surface.triangles.data()),
                        surface.triangles.size(), 3, self);
          },
          nb::sig("def faces(self) -> numpy.typing.NDArray[numpy.uint32]"),
          "Triangles of the surface, counter-clockwise seen from outside, as rows of vertices: (m, 3) "
          "uint32, read-only, no copy.")
      .def_prop_ro(
          "volume", [](const SharedPacking& p) { return p.packing().solid.volume; },
          "Volume of the solid, not of the spheres [m^3].")
      .def_prop_ro(
          "center_of_mass",
          [](const SharedPacking& p) { return copyOf(p.packing().solid.centre_of_mass, {3}); },
          nb::sig("def center_of_mass(self) -> numpy.typing.NDArray[numpy.float64]"),
          "Centre of mass of the homogeneous solid, in the packing's frame [m]: (3,) float64.")
      .def_prop_ro(
          "inertia",
          [](const SharedPacking& p) {
            return copyOf(p.packing().solid.inertia, {3, 3});
          },
          nb::sig("def inertia(self) -> numpy.typing.NDArray[numpy.float64]"),
          "Inertia about the centre of mass for unit density, along the axes of the solid [m^5]: (3, 3) "
          "float64. Times the density [kg/m^3] it is in kg m^2.")
      .def_prop_ro(
          "order",
          [](const SharedPacking& p) {
            return p.packing().order == SphereOrder::coverage ? "coverage" : "radius";
          },
          nb::sig("def order(self) -> typing.Literal['radius', 'coverage']"),
          "What the first spheres are chosen for: \"radius\" (the largest first) or \"coverage\", see "
          "pack().")
      .def_prop_ro(
          "coverage", &coverageRows, nb::sig("def coverage(self) -> numpy.typing.NDArray[typing.Any]"),
          R"(How near the first spheres come to the surface: a structured array, a row for 64, 128, ... spheres.

count      of spheres, uint32; the others are float64
mean, p95, max  distance from the surface to the nearest of them [m]: mean, 95th percentile, largest
farthest   where it is largest, in the packing's frame [m]
uncovered  part of the surface, 0 to 1, that is farther from them than a hundredth of the diagonal

What is far from all spheres is not felt by other packings. Empty if the surface is unknown.)")
      .def_prop_ro(
          "quality", &qualityOf, nb::sig("def quality(self) -> dict[str, float]"),
          R"(How well the spheres fill the solid. nan where that is unknown, as gaps of a slice are whose length is not in coverage.

density: volume of the spheres over that of the solid, 0 to 1.
gap_mean, gap_p95, gap_max: distance from the surface to the nearest sphere [m]: mean, 95th percentile, largest, of 50,000 points
    spread over the surface.
largest_missing_radius: no larger sphere fits between those that are there [m].)")
      .def_prop_ro(
          "overlap_errors", &overlapErrorsOf,
          nb::sig("def overlap_errors(self) -> tuple[tuple[int, list[tuple[float, float]], list[tuple[float, "
                  "float]]], ...]"),
          R"(How far off volumes of overlaps are: the mean |error|, relative to the larger of the found and the true volume, measured
with copies of the solid when it was packed. expected_error() looks them up, with bounds, and knows of planes that cut the
solid and of balls inside it.

A row for each number of spheres: that number, the errors with estimator="raw", and those with "volume_true". Of each some
pairs: how deep overlaps are, volume over area [m], and the error there. Empty with pack(overlap_errors=False).)")
      .def_prop_ro(
          "warnings", [](const SharedPacking& p) { return p.packing().warnings; },
          "What to know of the packing, a sentence each: what was mended in the mesh, parts without spheres.")
      .def_prop_ro("provenance", &provenanceOf, nb::sig("def provenance(self) -> dict[str, str]"),
                   "Where the packing comes from: source, source_hash, options, version.")
      .def("save", &save, "path"_a, "overwrite"_a = false,
           nb::sig("def save(self, path: str | os.PathLike[str], overwrite: bool = False) -> None"),
           R"(Writes the packing to a file: .cbor (small), .json (readable), or .ply or .xyzr (spheres only).

The file appears under its name only when it is complete. Raises FileExistsError without ``overwrite``,
WriteError, and InvalidArgumentError for another ending or a slice.)")
      .def("__len__", [](const SharedPacking& p) { return p.count; })
      .def("__getitem__", &slice, nb::sig("def __getitem__(self, index: slice) -> Packing"),
           "The first n spheres, as a packing: packing[:n]. Raises ValueError for any other slice.")
      .def("__repr__", &describe)
      .def("__eq__", &equal, nb::is_operator(), nb::sig("def __eq__(self, other: object, /) -> bool"))
      .def("__hash__", &hashOf)
      .def(
          "__copy__", [](nb::object self) { return self; }, nb::sig("def __copy__(self) -> Packing"))
      .def(
          "__deepcopy__", [](nb::object self, nb::handle) { return self; }, "memo"_a,
          nb::sig("def __deepcopy__(self, memo: dict) -> Packing"))
      .def("__getstate__", &state, nb::sig("def __getstate__(self) -> tuple[bytes, int]"))
      .def("__setstate__", &restore, nb::sig("def __setstate__(self, state: tuple[bytes, int]) -> None"));

  nb::class_<Mesh>(module, "Mesh", "Triangles that pack() takes.").def("stretch", &stretch, "factors"_a);
  module.def("read_mesh", &readScaledMesh, "path"_a, "scale"_a);
  module.def(
      "solid", [](const std::string& name) { return surfaceOf(makeNamedSolid(name)->surface()); }, "name"_a,
      nb::sig("def solid(name: str) -> tuple[numpy.typing.NDArray[numpy.float64], "
              "numpy.typing.NDArray[numpy.uint32]]"),
      R"(The surface of a solid to try things with: vertices (n, 3) [m] and faces (m, 3), as pack() takes them.

name: ball, box, cylinder, torus, link, bowl, gear, lbracket, knot, nut, bolt, chazelle, tray, cup, pan, blade or horn; about 1 m in
size. Nut and bolt mate: their thread has a pitch of 0.125 m. Raises InvalidArgumentError for another name.)");
  module.def("mesh_of", &meshOf, "vertices"_a, "faces"_a);
  module.def("surface_of_mesh", &surfaceOfMesh, "mesh"_a, "name"_a, "repair"_a);
  module.def("bodies_of", &bodiesOf, "vertices"_a, "faces"_a);
  module.def("pack", &packWith, "mesh"_a, "name"_a, "spheres"_a, "min_radius"_a, "density"_a, "gap"_a,
             "order"_a, "delta"_a, "overlap_errors"_a, "threads"_a, "repair"_a, "cache"_a,
             "progress"_a.none());
  module.def("cover", &coverPacking, "packing"_a, "resolution"_a);
  module.def("clump", &clumpOfPacking, "packing"_a, "outside_weight"_a);
  module.def("read", &readShared, "path"_a);
  const PackOptions defaults;
  module.attr("pack_defaults") = [&] {
    nb::dict all;
    all["spheres"] = defaults.spheres;
    all["min_radius"] = defaults.min_radius;
    all["density"] = defaults.density;
    all["gap"] = defaults.gap;
    all["order"] = "radius";
    all["delta"] = defaults.delta;
    all["overlap_errors"] = defaults.overlap_errors;
    all["threads"] = defaults.threads;
    all["repair"] = MeshOptions().repair;
    all["scale"] = MeshOptions().scale;
    return all;
  }();
}

}  // namespace innersphere::python
