// The summary of a scene.
#pragma once

#include <string>
#include <vector>

#include "report.hpp"
#include "scenes/scene.hpp"

namespace innersphere::tool {

/// What the page of its film says below the title: what the scene shows, how it was run, and what came of it.
void addTexts(const demo::Scene& scene, demo::ScenePlay& play);

Report describe(const demo::Scene& scene, const demo::ScenePlay& play);

/// One line: what was measured, what was expected, where that comes from, and whether the two agree.
std::string describe(const demo::Verdict& verdict);

nlohmann::ordered_json truthsJson(const std::vector<demo::Verdict>& verdicts);

/// False if one was missed.
bool allHold(const std::vector<demo::Verdict>& verdicts);

}  // namespace innersphere::tool
