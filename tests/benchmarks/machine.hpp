// Who measured what, where and when: the head of every table.
#pragma once

#include <string>

namespace innersphere::benchmarks {

/// Markdown lines with the machine, the date, the command and the version of the sources.
std::string heading(const std::string& title, int argc, char** argv);

/// Peak memory of this process so far [MiB].
double peakMemory();

}  // namespace innersphere::benchmarks
