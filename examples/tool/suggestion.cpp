#include "suggestion.hpp"

#include <algorithm>

namespace innersphere::tool {
namespace {

// Damerau and Levenshtein's distance, without edits of what was swapped.
std::size_t distanceBetween(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest(const std::string& typed, const std::vector<std::string>& names) {
  // A third of the letters may be wrong.
  std::size_t least = typed.size() / 3 + 1;
  std::string best;
  for (const std::string& name : names) {
    const std::size_t distance = distanceBetween(typed, name);
    if (distance < least)
      best = name;
    else if (distance == least)
      best.clear();
    least = std::min(least, distance);
  }
  return best;
}

std::string didYouMean(const std::string& typed, const std::vector<std::string>& names,
                       const std::string& otherwise) {
  const std::string name = nearest(typed, names);
  return name.empty() ? otherwise : "; did you mean " + name + "?";
}

}  // namespace innersphere::tool
