// Whether two runs are the same to the last bit.
#pragma once

#include <gtest/gtest.h>

#include "scenes/recording.hpp"

namespace innersphere::test {

inline void expectSameMotion(const demo::Recording& a, const demo::Recording& b) {
  ASSERT_EQ(a.states.size(), b.states.size());
  for (std::size_t i = 0; i < a.states.size(); ++i) {
    const std::size_t step = i / a.names.size();
    ASSERT_EQ(a.states[i].position, b.states[i].position) << "step " << step;
    ASSERT_EQ(a.states[i].rotation, b.states[i].rotation) << "step " << step;
    ASSERT_EQ(a.states[i].velocity, b.states[i].velocity) << "step " << step;
    ASSERT_EQ(a.states[i].spin, b.states[i].spin) << "step " << step;
  }
}

}  // namespace innersphere::test
