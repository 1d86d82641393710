#include "surface/box_search.hpp"

#include "surface/kernels.hpp"

namespace innersphere {

namespace {

using Index = GridSurface::Index;
using Node = GridSurface::Node;
constexpr std::size_t kMost = SurfaceTree::kWidth * SurfaceTree::kWidth;  ///< pairs of two nodes' children

/// Goes down both trees, a level after the other: pairs of a level do not wait for each other.
template <class Kernels>
inline void search(GridSurface& a, GridSurface& b, Pairs& found) {
  static thread_local Pairs of_thread;
  Pairs& open = here(of_thread);
  open.count = 0;
  open.makeRoom(1);
  open.a[0] = open.b[0] = 0;
  open.count = 1;
  found.count = 0;
  for (std::size_t i = 0; i < open.count; ++i) {
    const Index index_a = open.a[i], index_b = open.b[i];
    const Node &of_a = a.node(index_a), &of_b = b.node(index_b);
    Index met = Kernels::meeting(of_a, of_b);
    FourInts children_a = fourAt(of_a.children.data()), children_b = fourAt(of_b.children.data());
    // A node of triangles stays as it is while the other one is taken apart.
    if (of_a.are_triangles && !of_b.are_triangles) {
      children_a = FourInts{} + static_cast<std::int32_t>(index_a);
      met |= met >> 8;
      met = (met | met >> 4) & 0xf;
    } else if (of_b.are_triangles && !of_a.are_triangles) {
      children_b = FourInts{} + static_cast<std::int32_t>(index_b);
      met |= met >> 2;
      met = (met | met >> 1) & 0x1111;
    }
    Pairs& to = of_a.are_triangles && of_b.are_triangles ? found : open;
    to.makeRoom(kMost);
    to.count += Kernels::append(met, children_a, children_b, &to.a[to.count], &to.b[to.count]);
  }
}

#ifdef INNERSPHERE_AVX512_SURFACE
INNERSPHERE_AVX512_SURFACE void searchAvx512(GridSurface& a, GridSurface& b, Pairs& found) {
  search<Avx512Kernels>(a, b, found);
}
#endif

}  // namespace

void findPairs(GridSurface& a, GridSurface& b, Pairs& found) {
#ifdef INNERSPHERE_AVX512_SURFACE
  if (a.isWide()) return searchAvx512(a, b, found);
#endif
  search<AnyKernels>(a, b, found);
}

}  // namespace innersphere
