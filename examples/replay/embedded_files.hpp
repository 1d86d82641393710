// Text files that the build puts into the program.
#pragma once

#include <string_view>

namespace innersphere::demo {

extern const std::string_view kPageHtml;
extern const std::string_view kPageCss;
extern const std::string_view kPageJs;
extern const std::string_view kThreeJs;
extern const std::string_view kOrbitControlsJs;

}  // namespace innersphere::demo
