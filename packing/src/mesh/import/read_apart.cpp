#include "mesh/import/read_apart.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <new>

#include "common/bounds.hpp"
#include "innersphere/error.hpp"
#include "mesh/import/byte_cursor.hpp"

namespace innersphere {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMemory = std::size_t{1} << 30;
// assimp reads its slowest formats at several megabytes a second, and small files in milliseconds. A small
// file that hangs is given up within five seconds.
constexpr double kSeconds = 4, kSecondsPerByte = 1e-6;

// The message: what follows, two sizes, then the vertices and triangles of a mesh or the text of an error.
enum class Answer : std::uint32_t { mesh, error };

double secondsFor(const std::string& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  return kSeconds + (error ? 0 : kSecondsPerByte * static_cast<double>(size));
}

void lower(decltype(RLIMIT_AS) resource, rlim_t most) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min(limit.rlim_cur, most);
  setrlimit(resource, &limit);
}

// What the process has already, such as a GPU's address space, does not count.
void limitChild(double seconds) {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  lower(RLIMIT_AS, pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + kMemory);
  lower(RLIMIT_CPU, static_cast<rlim_t>(seconds) + 2);
  lower(RLIMIT_CORE, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (int signal : {SIGINT, SIGTERM, SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGALRM, SIGPIPE}) {
    std::signal(signal, SIG_DFL);
  }
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);  // the last words of a crash
}

void send(int pipe, const void* data, std::size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = write(pipe, next, size);
    if (n < 0 && errno != EINTR) _exit(1);
    if (n <= 0) continue;
    next += n;
    size -= static_cast<std::size_t>(n);
  }
}

void sendHead(int pipe, Answer answer, std::uint64_t first, std::uint64_t second) {
  send(pipe, &answer, sizeof answer);
  send(pipe, &first, sizeof first);
  send(pipe, &second, sizeof second);
}

void sendError(int pipe, ErrorCode code, const char* message) {
  const std::size_t size = std::strlen(message);
  sendHead(pipe, Answer::error, static_cast<std::uint64_t>(code), size);
  send(pipe, message, size);
}

[[noreturn]] void runChild(int pipe, Mesh (*read)(const std::string&), const std::string& path,
                           double seconds) {
  try {
    limitChild(seconds);
    const Mesh mesh = read(path);
    sendHead(pipe, Answer::mesh, mesh.vertices.size(), mesh.triangles.size());
    send(pipe, mesh.vertices.data(), mesh.vertices.size() * sizeof mesh.vertices[0]);
    send(pipe, mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
  } catch (const Error& error) {
    sendError(pipe, error.code(), error.what());
  } catch (const std::bad_alloc&) {
    sendError(pipe, ErrorCode::bad_format, (path + " needs more than 1 GB of memory to be read").c_str());
  } catch (...) {
    sendError(pipe, ErrorCode::bad_format, (path + " cannot be read as a mesh; export it again").c_str());
  }
  _exit(0);
}

class Child {
 public:
  Child(Mesh (*read)(const std::string&), const std::string& path, double seconds) : path_(path) {
    // Held so that no child keeps the pipe of another one open.
    static std::mutex forking;
    const std::lock_guard lock(forking);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) fail(std::string("no pipe: ") + std::strerror(errno));
    id_ = fork();
    if (id_ == 0) runChild(ends[1], read, path, seconds);
    const int code = errno;
    close(ends[1]);
    pipe_ = ends[0];
    if (id_ < 0) {
      close(pipe_);
      fail(std::string("no child process: ") + std::strerror(code));
    }
  }
  ~Child() {
    close(pipe_);
    if (id_ > 0) kill(id_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// All that the child sends until it ends. Throws Error if that is not in time.
  std::string receive(double seconds) {
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    std::string bytes;
    char block[1 << 16];
    while (true) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
      pollfd ready{pipe_, POLLIN, 0};
      if (left <= 0) fail("reading takes longer than " + std::to_string(static_cast<int>(seconds)) + " s");
      if (poll(&ready, 1, static_cast<int>(std::min<long>(left, 1000))) <= 0) continue;
      const ssize_t n = ::read(pipe_, block, sizeof block);
      if (n == 0) return bytes;
      if (n > 0) bytes.append(block, static_cast<std::size_t>(n));
      if (bytes.size() > kMemory) fail("it has over 1 GB of vertices and triangles");
    }
  }

  /// Throws what a child without an answer died of.
  [[noreturn]] void failWithCause() {
    const int status = wait();
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (signal == SIGINT || signal == SIGTERM) {
      throw Error(ErrorCode::cancelled, "reading " + path_ + " was cancelled");
    }
    fail(signal != 0 ? "its reader crashed (" + std::string(strsignal(signal)) + ")"
                     : "its reader ended without an answer");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::bad_format, path_ + " cannot be read as a mesh: " + what +
                                           "; export it again, as OBJ, STL, PLY or OFF if you can");
  }

  int wait() {
    int status = 0;
    while (id_ > 0 && waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = 0;
    return status;
  }

  const std::string& path_;
  pid_t id_ = 0;
  int pipe_ = -1;
};

Mesh meshFrom(ByteCursor& cursor, std::uint64_t vertices, std::uint64_t triangles) {
  Mesh mesh;
  if (vertices > cursor.left() / sizeof mesh.vertices[0] ||
      triangles > cursor.left() / sizeof mesh.triangles[0] || vertices > UINT32_MAX) {
    cursor.fail("the reader's answer was cut");
  }
  mesh.vertices.resize(vertices);
  mesh.triangles.resize(triangles);
  for (Vec3d& v : mesh.vertices) {
    for (double& x : v) x = cursor.take<double>();
    if (!isFinite(v)) cursor.fail("the reader's answer is damaged");
  }
  for (auto& t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      v = cursor.take<std::uint32_t>();
      if (v >= vertices) cursor.fail("the reader's answer is damaged");
    }
  }
  return mesh;
}

}  // namespace

Mesh readApart(Mesh (*read)(const std::string& path), const std::string& path) {
  const double seconds = secondsFor(path);
  Child child(read, path, seconds);
  const std::string bytes = child.receive(seconds);
  if (bytes.empty()) child.failWithCause();
  ByteCursor cursor(bytes, path, std::endian::native);
  const auto answer = cursor.take<std::uint32_t>();
  const auto first = cursor.take<std::uint64_t>(), second = cursor.take<std::uint64_t>();
  if (answer == static_cast<std::uint32_t>(Answer::mesh)) return meshFrom(cursor, first, second);
  if (first > static_cast<std::uint64_t>(ErrorCode::device_out_of_memory) || second != cursor.left()) {
    cursor.fail("the reader's answer is damaged");
  }
  throw Error(static_cast<ErrorCode>(first), bytes.substr(bytes.size() - second));
}

}  // namespace innersphere
