// Reads a mesh where a defect of the reader can do no harm.
#pragma once

#include <string>

#include "innersphere/geometry.hpp"

namespace innersphere {

/// Calls read(path) in a forked child process and returns its mesh. The child may take 1 GB of memory, and 4
/// s and a second more for each megabyte of the file. Throws the Error that read() threw; bad_format if the
/// child crashed or met a limit, or if what it sent is no mesh; cancelled if SIGINT or SIGTERM ended it.
///
/// Only the calling thread lives on in the child. glibc makes its allocator usable there; a lock of another
/// library that another thread held at that moment stays locked, and the time limit then ends the child. The
/// caller sees an error at worst, and may call again.
Mesh readApart(Mesh (*read)(const std::string& path), const std::string& path);

}  // namespace innersphere
