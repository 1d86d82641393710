// Overlap queries: arrays of poses in, structured arrays out, without the GIL in between.
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <utility>
#include <variant>
#include <vector>

#include "bindings.hpp"
#include "innersphere/bounded_query.hpp"
#include "innersphere/query.hpp"
#include "poses.hpp"
#include "structured.hpp"

namespace innersphere::python {
namespace {

using namespace nb::literals;

constexpr std::pair<const char*, Estimator> kEstimators[] = {
    {"volume_true", Estimator::volume_true}, {"raw", Estimator::raw}, {"surface", Estimator::surface}};
constexpr std::pair<const char*, Want> kWants[] = {
    {"touch", Want::touch}, {"volume", Want::volume}, {"wrench", Want::wrench}};

/// The types of structured results. They live as long as the module.
struct Types {
  PyObject* overlap = nullptr;
  PyObject* pair = nullptr;
  PyObject* contact = nullptr;
  PyObject* error = nullptr;
};
Types types;

/// Items of all queries, and where those of each begin.
template <typename T>
nb::tuple ranges(QueryResult::Ranges<T>&& found, nb::handle type) {
  auto* first = new std::vector<std::size_t>(std::move(found.first));
  const nb::capsule owner(first, [](void* p) noexcept { delete static_cast<std::vector<std::size_t>*>(p); });
  return nb::make_tuple(structuredArray(std::move(found.items), type),
                        nb::ndarray<nb::numpy, std::int64_t>(reinterpret_cast<std::int64_t*>(first->data()),
                                                             {first->size()}, owner));
}

/// Notes that this process may use a device. Throws Error device_error in a process that was forked from one
/// that did: nothing of CUDA works there.
void enterDevice() {
  static std::atomic<pid_t> first{0};
  const pid_t here = getpid();
  pid_t before = 0;
  if (first.compare_exchange_strong(before, here) || before == here) return;
  throw Error(
      ErrorCode::device_error,
      "this process was forked from one that may use CUDA, which does not survive that: start processes "
      "by multiprocessing.get_context(\"spawn\"), or use Query(\"cpu\")");
}

/// Numbers beyond an int stay out of range.
int inInt(std::int64_t x) {
  return static_cast<int>(
      std::clamp<std::int64_t>(x, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

/// Runs queries for Python. One at a time: a second thread waits for the first.
class Query {
 public:
  Query(const std::string& backend, std::int64_t threads,
        std::variant<std::monostate, int, std::string> device)
      : Query({parseWord("backend", backend, kBackends), inInt(threads), false, deviceOf(device)}) {}

  nb::object overlap(const SharedPacking& a, const SharedPacking& b, nb::handle pose_a, nb::handle pose_b,
                     const std::string& want, const std::string& estimator, double margin, nb::object out) {
    const QueryOptions options{parseWord("want", want, kWants),
                               parseWord("estimator", estimator, kEstimators)};
    const bool on_host = on_host_ || options.estimator == Estimator::surface;
    const Batch batch(a, b, pose_a, pose_b, margin, on_host ? Where::host : Where::anywhere);
    if (!out.is_none()) {
      write(batch, options, out);
      return out;
    }
    std::vector<Overlap> overlaps = batch.isSweep() ? sweep(batch, options) : run(batch, options).overlaps;
    const nb::object array = structuredArray(std::move(overlaps), types.overlap);
    if (batch.shape.empty()) return array[0];
    if (batch.shape.size() == 1) return array;
    nb::list shape;
    for (const std::size_t n : batch.shape) shape.append(n);
    return array.attr("reshape")(nb::tuple(shape));
  }

  nb::tuple pairs(const SharedPacking& a, const SharedPacking& b, nb::handle pose_a, nb::handle pose_b,
                  const std::string& estimator, double margin) {
    const Batch batch(a, b, pose_a, pose_b, margin);
    QueryResult result = run(batch, {Want::pairs, parseWord("estimator", estimator, kEstimators)});
    return ranges(std::move(result.pairs), types.pair);
  }

  nb::tuple contacts(const SharedPacking& a, const SharedPacking& b, nb::handle pose_a, nb::handle pose_b,
                     const std::string& estimator, double margin) {
    const Batch batch(a, b, pose_a, pose_b, margin);
    QueryResult result = run(batch, {Want::contacts, parseWord("estimator", estimator, kEstimators)});
    return nb::make_tuple(ranges(std::move(result.contacts_a), types.contact),
                          ranges(std::move(result.contacts_b), types.contact));
  }

  const char* lastBackend() {
    const nb::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    return context_.lastBackend() == Backend::cuda ? "cuda" : "cpu";
  }

 private:
  explicit Query(const QueryContextOptions& options)
      : context_(options), on_host_(options.backend == Backend::cpu || !cudaAvailable()) {
    if (!on_host_) enterDevice();
  }

  struct Batch {
    const SharedPacking& a;
    const SharedPacking& b;
    Poses poses_a;
    Poses poses_b;
    double margin;
    std::vector<std::size_t> shape;
    std::size_t count = 1;
    bool a_stands = false;  ///< in one pose

    /// `where`: of arrays that a device may read in place, if it can.
    Batch(const SharedPacking& a, const SharedPacking& b, nb::handle pose_a, nb::handle pose_b, double margin,
          Where where = Where::host)
        : a(a),
          b(b),
          poses_a(pose_a, "pose_a"),
          poses_b(pose_b, "pose_b", poses_a.isSingle() && inFramesOfSolids() ? where : Where::host),
          margin(margin) {
      shape = commonShape(poses_a.shape(), poses_b.shape(), "pose_a and pose_b");
      a_stands = poses_a.isSingle();
      poses_a.broadcast(shape);
      poses_b.broadcast(shape);
      for (const std::size_t n : shape) count *= n;
    }

    /// Whether the arrays can be read as they are: A stands still, and no frame differs from its solid's.
    bool isSweep() const {
      return a_stands && !shape.empty() && inFramesOfSolids() && poses_b.inPlace().count > 0;
    }

    bool inFramesOfSolids() const { return a.packing().origin == Vec3d{} && b.packing().origin == Vec3d{}; }
  };

  static int deviceOf(const std::variant<std::monostate, int, std::string>& device) {
    if (std::holds_alternative<std::monostate>(device)) return kCurrentDevice;
    if (const int* number = std::get_if<int>(&device)) {
      if (*number < 0) throw nb::value_error("device is negative; the first one is 0");
      return *number;
    }
    if (std::get<std::string>(device) != "all")
      throw nb::value_error("device must be a number, \"all\" or None");
    return kAllDevices;
  }

  static PairQuery pairOf(const Batch& batch) {
    PairQuery query;
    query.a = batch.a.model.get();
    query.b = batch.b.model.get();
    query.prefix_a = batch.a.count;
    query.prefix_b = batch.b.count;
    query.margin = batch.margin;
    return query;
  }

  std::vector<Overlap> sweep(const Batch& batch, const QueryOptions& options) {
    std::vector<Overlap> overlaps(batch.count);
    sweep(batch, options, overlaps.data());
    return overlaps;
  }

  void sweep(const Batch& batch, const QueryOptions& options, Overlap* overlaps) {
    const nb::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    if (!on_host_) enterDevice();
    PairQuery pair = pairOf(batch);
    batch.poses_a.forEach(1, [&](std::size_t, const Placement& pose) { pair.placement_a = pose; });
    context_.sweep(pair, batch.poses_b.inPlace(), options, overlaps);
  }

  /// Writes results into an array of the user's.
  void write(const Batch& batch, const QueryOptions& options, nb::handle out) {
    nb::ndarray<double, nb::c_contig> array;
    const nb::object on_device = nb::module_::import_("innersphere._arrays").attr("on_device")(out);
    if (!on_device.is_none() && !cudaAvailable())
      throw Error(ErrorCode::no_device, "out is on a CUDA device, which innersphere cannot use");
    if (!nb::try_cast(on_device.is_none() ? out : nb::handle(on_device), array, false))
      throw nb::type_error("out must be an array of float64 in C's order that can be written to");
    std::vector<std::size_t> shape = batch.shape;
    shape.push_back(kColumns);
    bool fits = array.ndim() == shape.size();
    for (std::size_t k = 0; fits && k < shape.size(); ++k) fits = array.shape(k) == shape[k];
    if (!fits) throw nb::value_error("out must have the shape of the poses, and 16 columns");
    auto* overlaps = reinterpret_cast<Overlap*>(array.data());
    if (batch.isSweep()) return sweep(batch, options, overlaps);
    if (!on_device.is_none()) {
      throw Error(ErrorCode::bad_argument,
                  "out is on a device: pose_a must then be a single pose, and pose_b one array of float64 in "
                  "C's order, of solids that are less than eight of their sizes from their origins");
    }
    const std::vector<Overlap> found = run(batch, options).overlaps;
    std::copy(found.begin(), found.end(), overlaps);
  }

  QueryResult run(const Batch& batch, const QueryOptions& options) {
    const nb::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    if (!on_host_) enterDevice();
    const Packing& a = batch.a.packing();
    const Packing& b = batch.b.packing();
    queries_.assign(batch.count, pairOf(batch));
    batch.poses_a.forEach(batch.count, [&](std::size_t i, const Placement& pose) {
      queries_[i].placement_a = placed(a, pose);
    });
    batch.poses_b.forEach(batch.count, [&](std::size_t i, const Placement& pose) {
      queries_[i].placement_b = placed(b, pose);
    });
    QueryResult result;
    context_.run(queries_.data(), queries_.size(), options, result);
    toFramesOfSolids(a, b, result);
    return result;
  }

  /// The query's points are relative to the packings' frames, which differ from those of the solids for
  /// solids that are far from their own origin.
  void toFramesOfSolids(const Packing& a, const Packing& b, QueryResult& result) const {
    const auto turned = [](const Placement& place, const Vec3d& v) {
      const Mat3d& r = place.rotation;
      return Vec3d{r[0] * v.x + r[1] * v.y + r[2] * v.z, r[3] * v.x + r[4] * v.y + r[5] * v.z,
                   r[6] * v.x + r[7] * v.y + r[8] * v.z};
    };
    std::vector<Overlap>& overlaps = result.overlaps;
    if (a.origin != Vec3d{}) {
      for (std::size_t i = 0; i < overlaps.size(); ++i) {
        const Vec3d origin = turned(queries_[i].placement_a, a.origin);
        if (overlaps[i].volume > 0) overlaps[i].centroid = overlaps[i].centroid + origin;
        for (auto* contacts : {&result.contacts_a, &result.contacts_b}) {
          if (contacts->items.empty()) continue;
          for (std::size_t k = contacts->first[i]; k < contacts->first[i + 1]; ++k)
            for (int axis = 0; axis < 3; ++axis)
              contacts->items[k].centroid[axis] += static_cast<float>(origin[axis]);
        }
      }
    }
    if (b.origin != Vec3d{}) {
      for (std::size_t i = 0; i < overlaps.size(); ++i)
        overlaps[i].torque =
            overlaps[i].torque + cross(turned(queries_[i].placement_b, b.origin), overlaps[i].force);
    }
  }

  static constexpr std::size_t kColumns = 16;  ///< of `out`
  static_assert(sizeof(Overlap) == kColumns * sizeof(double));

  std::mutex mutex_;
  QueryContext context_;
  bool on_host_ = false;  ///< always
  std::vector<PairQuery> queries_;
};

/// Throws TypeError unless there are the fields that foretell errors.
void requireFields(nb::handle shared) {
  for (const char* field : {"volume", "area", "stiffness", "energy"}) {
    try {
      const nb::object found = shared[field];
    } catch (nb::python_error& error) {
      if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_LookupError) &&
          !error.matches(PyExc_ValueError))
        throw;
      throw nb::type_error(("shared has no field \"" + std::string(field) +
                            "\"; give what Query.overlap() returned for the two packings")
                               .c_str());
    }
  }
}

nb::object expectedErrors(const SharedPacking& a, const SharedPacking& b, nb::handle shared,
                          const std::string& estimator) {
  const nb::object as_float64 = nb::module_::import_("innersphere._arrays").attr("as_float64");
  requireFields(shared);
  const nb::object given = as_float64(shared["volume"], "volume");
  using Numbers = nb::ndarray<const double, nb::ndim<1>, nb::c_contig>;
  const auto volumes = nb::cast<Numbers>(given.attr("ravel")());
  const auto areas = nb::cast<Numbers>(as_float64(shared["area"], "area").attr("ravel")());
  const auto stiffnesses = nb::cast<Numbers>(as_float64(shared["stiffness"], "stiffness").attr("ravel")());
  const auto energies = nb::cast<Numbers>(as_float64(shared["energy"], "energy").attr("ravel")());
  if (areas.size() != 3 * volumes.size() || stiffnesses.size() != volumes.size() ||
      energies.size() != volumes.size())
    throw Error(
        ErrorCode::bad_argument,
        "there must be a volume, an area of three numbers, a stiffness and an energy of each overlap");
  PairQuery query;
  query.a = a.model.get();
  query.b = b.model.get();
  query.prefix_a = a.count;
  query.prefix_b = b.count;
  const Estimator by = parseWord("estimator", estimator, kEstimators);
  bool any = false, energies_are_volumes = true;  // as by triangles alone
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    if (!(volumes.data()[i] > 0)) continue;
    any = true;
    energies_are_volumes = energies_are_volumes && energies.data()[i] == volumes.data()[i];
  }
  if (by != Estimator::surface && any && energies_are_volumes) {
    throw Error(
        ErrorCode::bad_argument,
        "energy is volume, as estimator=\"surface\" has it: name the estimator that found the overlaps");
  }
  std::vector<ExpectedError> errors;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const double* area = areas.data() + 3 * i;
    Overlap found;
    found.volume = volumes.data()[i];
    found.area = {area[0], area[1], area[2]};
    found.stiffness = stiffnesses.data()[i];
    found.energy = energies.data()[i];
    errors.push_back(expectedError(query, by, found));
  }
  return structuredArray(std::move(errors), types.error)
      .attr("reshape")(given.attr("shape"))
      .attr("__getitem__")(nb::tuple());
}

nb::object overlapType() {
  return structuredType(sizeof(Overlap), {{"volume", "<f8", offsetIn(&Overlap::volume)},
                                          {"centroid", "(3,)<f8", offsetIn(&Overlap::centroid)},
                                          {"force", "(3,)<f8", offsetIn(&Overlap::force)},
                                          {"torque", "(3,)<f8", offsetIn(&Overlap::torque)},
                                          {"area", "(3,)<f8", offsetIn(&Overlap::area)},
                                          {"stiffness", "<f8", offsetIn(&Overlap::stiffness)},
                                          {"energy", "<f8", offsetIn(&Overlap::energy)},
                                          {"pair_count", "<u8", offsetIn(&Overlap::pair_count)}});
}

}  // namespace

void bindOverlaps(nb::module_& module) {
  nb::object overlap = overlapType();
  nb::object pair = structuredType(
      sizeof(SpherePair), {{"a", "<u4", offsetof(SpherePair, a)}, {"b", "<u4", offsetof(SpherePair, b)}});
  module.attr("overlap_dtype") = overlap;
  module.attr("pair_dtype") = pair;
  nb::object contact =
      structuredType(sizeof(SphereContact), {{"sphere", "<u4", offsetof(SphereContact, sphere)},
                                             {"volume", "<f4", offsetof(SphereContact, volume)},
                                             {"centroid", "(3,)<f4", offsetof(SphereContact, centroid)},
                                             {"area", "(3,)<f4", offsetof(SphereContact, area)}});
  module.attr("sphere_contact_dtype") = contact;
  nb::object error = structuredType(
      sizeof(ExpectedError),
      {{"mean", "<f8", offsetof(ExpectedError, mean)}, {"bound", "<f8", offsetof(ExpectedError, bound)}});
  module.attr("expected_error_dtype") = error;
  types = {overlap.release().ptr(), pair.release().ptr(), contact.release().ptr(), error.release().ptr()};

  nb::class_<Query>(module, "Query",
                    R"(Finds the volume that two packings share, and the force that drives them apart.

backend: "auto" (the CPU or, if there is enough work and a device, CUDA; both give the same bits), "cpu", or "cuda",
    which raises NoDeviceError where there is none.
threads: of the CPU, up to 4,096; 0 are all cores. Results do not depend on it.
device: the CUDA device, from 0 on; "all": they share the poses of a query; None: the current one, as a rule 0. Results
    do not depend on it. It need not be there as long as queries run on the CPU.

A query is fastest where A stands still and the poses of B are one array of doubles in C's order, of matrices or of
positions and quaternions: it is then read in place, by a device, too.

The GIL is free while a query runs. One object runs one query at a time: give each thread its own.)")
      .def(nb::init<const std::string&, std::int64_t, std::variant<std::monostate, int, std::string>>(),
           "backend"_a = "auto", "threads"_a = 0, "device"_a.none() = nb::none(),
           nb::sig("def __init__(self, backend: typing.Literal['auto', 'cpu', 'cuda'] = 'auto', threads: int "
                   "= 0, device: int | typing.Literal['all'] | None = None) -> None"))
      .def("overlap", &Query::overlap, "a"_a, "b"_a, "pose_a"_a.none() = nb::none(),
           "pose_b"_a.none() = nb::none(), nb::kw_only(), "want"_a = "wrench", "estimator"_a = "volume_true",
           "margin"_a = 0.0, "out"_a.none() = nb::none(),
           nb::sig("def overlap(self, a: Packing, b: Packing, pose_a: numpy.typing.ArrayLike | "
                   "tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike] | None = None, pose_b: "
                   "numpy.typing.ArrayLike | tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike] | None = "
                   "None, *, want: typing.Literal['touch', 'volume', 'wrench'] = 'wrench', estimator: "
                   "typing.Literal['volume_true', 'raw', 'surface'] = 'volume_true', margin: float = 0.0, "
                   "out: typing.Any "
                   "= None) -> typing.Any"),
           R"(Overlaps of two packings in one pose or in many.

a, b: packings, or slices of them: packing[:256].
pose_a, pose_b: where the solids are in the world. Each is None (at the origin), an array (..., 4, 4) of matrices that
    act on columns, or a tuple of positions (..., 3) [m] and unit quaternions (..., 4), x y z w. The shapes before that
    are broadcast together, as numpy does it.
want: "touch" (pair_count is 0 or 1, all else is zero), "volume" (volume, centroid, pair_count) or "wrench" (all).
    Less costs less.
estimator: "volume_true" (radii whose volumes sum to the solid's), "raw" (those of the spheres: volumes are low) or
    "surface" (the triangles that both packings carry: exact, but slower, and without a margin; spheres give only
    "touch").
margin: distance up to which spheres count as overlapping [m], at least 0. All spheres of A grow by it.
out: None, or an array of float64 in C's order of the shape of the poses and 16 columns, which is written to and returned:
    the fields below, one after the other, in the last column the bits of pair_count. It may be on a CUDA device
    (torch, cupy, by DLPack): then nothing is copied to the host. If a pose is refused, some rows are written.

Poses of B on a CUDA device are read in place where A has a single pose, and where they are float64 in C's order, with any
backend but "cpu" and any estimator but "surface"; others are copied to the host. What was enqueued before is waited for.

Returns a structured array of the shape of the poses; for a single pose one element of it. Vectors have the axes of the
world. The fields, all float64 but the last:

volume      that they share [m^3], at most that of the smaller solid with "volume_true"
centroid    of that volume, relative to the translation of pose_a [m]; zero where nothing overlaps
force       on B for unit stiffness [m^3]: minus the gradient of energy
torque      of that force on B about the translation of pose_b [m^4]
area        minus the gradient of volume by the position of B [m^2]: along the normal, as long as the contact is large
stiffness   by which the force grows with depth [m^2]
energy      potential of the force for unit stiffness [m^4]
pair_count  overlapping pairs of spheres, or of triangles that meet ("surface"), uint64

Where a solid lies nearly upon its copy its spheres with "volume_true", which overlap each other a little, meet themselves, and
their lenses sum up to a tenth to a quarter more than there is. volume ends at what the smaller solid has (without a margin); all else is that
of the lenses.

With estimator="surface" the law of force is another one: energy is the volume, force is area, torque is minus the
gradient of the volume by a rotation about the translation of pose_b [m^3], and stiffness is the area of B's surface
that is in A.

Raises TypeError and ValueError for arrays of the wrong type or shape; InvalidArgumentError and NotFiniteError, with
the number of the query in C's order, for poses that are none; DeviceError. With estimator="surface" also
EmptyInputError for a packing without triangles, NotASolidError for triangles that are not closed.)")
      .def("pairs", &Query::pairs, "a"_a, "b"_a, "pose_a"_a.none() = nb::none(),
           "pose_b"_a.none() = nb::none(), nb::kw_only(), "estimator"_a = "volume_true", "margin"_a = 0.0,
           nb::sig("def pairs(self, a: Packing, b: Packing, pose_a: numpy.typing.ArrayLike | "
                   "tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike] | None = None, pose_b: "
                   "numpy.typing.ArrayLike | tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike] | None = "
                   "None, *, estimator: typing.Literal['volume_true', 'raw'] = 'volume_true', margin: float "
                   "= 0.0) -> tuple[numpy.typing.NDArray[typing.Any], numpy.typing.NDArray[numpy.int64]]"),
           R"(The overlapping pairs of spheres. Arguments and errors are those of overlap().

Returns (pairs, first): a structured array with the fields a and b, uint32, rows of a.spheres and b.spheres; and where
the pairs of each query begin: those of query i are pairs[first[i]:first[i + 1]], sorted. Queries are in C's order.)")
      .def("contacts", &Query::contacts, "a"_a, "b"_a, "pose_a"_a.none() = nb::none(),
           "pose_b"_a.none() = nb::none(), nb::kw_only(), "estimator"_a = "volume_true", "margin"_a = 0.0,
           nb::sig("def contacts(self, a: Packing, b: Packing, pose_a: numpy.typing.ArrayLike | "
                   "tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike] | None = None, pose_b: "
                   "numpy.typing.ArrayLike | tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike] | None = "
                   "None, *, estimator: typing.Literal['volume_true', 'raw'] = 'volume_true', margin: float "
                   "= 0.0) -> tuple[tuple[numpy.typing.NDArray[typing.Any], "
                   "numpy.typing.NDArray[numpy.int64]], tuple[numpy.typing.NDArray[typing.Any], "
                   "numpy.typing.NDArray[numpy.int64]]]"),
           R"(What each sphere contributes to the overlap. Arguments and errors are those of overlap().

Returns ((contacts, first) of A, (contacts, first) of B): structured arrays with a row for each sphere that touches,
and where the rows of each query begin, as pairs() returns it. Their fields, float32 but the first:

sphere      row of a.spheres or b.spheres, uint32
volume      of its lenses with all spheres of the other [m^3]
centroid    of these, relative to the translation of pose_a [m]
area        sum of the areas of their rims, along the lines from A's centres to B's [m^2])")
      .def_prop_ro("last_backend", &Query::lastBackend,
                   nb::sig("def last_backend(self) -> typing.Literal['cpu', 'cuda']"),
                   "Where the last query ran: cpu or cuda; cpu before the first.");
  module.def("expected_error", &expectedErrors, "a"_a, "b"_a, "shared"_a, "estimator"_a = "volume_true",
             nb::sig("def expected_error(a: Packing, b: Packing, shared: typing.Any, estimator: "
                     "typing.Literal['volume_true', 'raw', 'surface'] = 'volume_true') -> typing.Any"),
             R"(How far off volumes are to be expected that Query.overlap() found for two packings.

shared: what Query.overlap() returned, or else something with shared["volume"] [m^3], shared["area"] and shared["stiffness"] [m^2] and
shared["energy"] [m^4].
estimator: with which they were found.

Returns two fields of the same shape, parts of the larger of the found and the true volume, from 0 to 1:

mean   expected |error|
bound  what |error| exceeds in 1 of 20 cases: else the truth lies between volume (1 - bound) and volume / (1 - bound)

Errors of A and B are independent, as each was measured with copies of itself, cut by planes and with balls inside it when it was packed. nan where
nothing overlaps, nothing so shallow was measured or area and energy are 0, as with want="volume", for packings without
overlap_errors, and with "volume_true" where more than 45 % of both are shared if a packing is of an older file. With "surface" 0, but nan
if the triangles of a packing enclose another volume than its solid has, by more than 0.1 %: shells that overlap enclose a part twice,
chords of a curve leave one out.
Raises InvalidArgumentError if shared is what "surface" finds and another estimator is named.)");
  module.def("cuda_device_count", &cudaDeviceCount, "The number of CUDA devices that answer.");
  module.def("cuda_available", &cudaAvailable, "Whether CUDA is built in and a device answers.");
}

}  // namespace innersphere::python
