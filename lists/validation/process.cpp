#include "lists/validation/process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <list>
#include <span>

#include "base/error.h"
#include "base/interruption.h"

namespace sfumato::lists::validation {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A file descriptor that closes itself.
class Stream {
 public:
  explicit Stream(int number) : number_(number) {}
  Stream(Stream&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Stream& operator=(Stream&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Stream() { close(); }
  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

struct Pipe {
  Stream read{-1};
  Stream write{-1};
};

Pipe makePipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    base::fail(base::ExitCode::Bug, "validate: no pipe to a check: {}", std::strerror(errno));
  return {Stream(ends[0]), Stream(ends[1])};
}

class Child {
 public:
  Child(const Command& command, size_t index) : index_(index) {
    std::vector<char*> arguments;
    for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    Pipe out = makePipe(), err = makePipe();
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ < 0)
      base::fail(base::ExitCode::Bug, "validate: a check cannot be started: {}", std::strerror(errno));
    if (pid_ == 0) become(arguments, out.write.number(), err.write.number(), parent);
    process_ = Stream(static_cast<int>(syscall(SYS_pidfd_open, pid_, 0)));
    out_ = std::move(out.read);
    err_ = std::move(err.read);
    for (const Stream* stream : {&out_, &err_}) fcntl(stream->number(), F_SETFL, O_NONBLOCK);
  }
  Child(Child&&) = delete;
  ~Child() {
    if (pid_ > 0) end();
  }

  size_t index() const { return index_; }
  double seconds() const { return secondsSince(start_); }
  bool hasEnded() const { return hasEnded_; }
  std::array<pollfd, 3> polled() const {
    return {{{out_.number(), POLLIN, 0}, {err_.number(), POLLIN, 0}, {process_.number(), POLLIN, 0}}};
  }

  // Takes what it wrote, once it is known what has happened.
  void read(std::span<const pollfd> polled) {
    if (polled[2].revents != 0) hasEnded_ = true;
    append(out_, ended_.out);
    append(err_, ended_.err);
  }

  // Waits for it, or kills it first where `how` says so.
  Ended end(Ended::How how = Ended::How::Interrupted) {
    if (how != Ended::How::Exited) {
      kill(-pid_, SIGKILL);  // and what it has started itself
      kill(pid_, SIGKILL);
    }
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = 0;
    ended_.seconds = seconds();
    ended_.how = how;
    if (how == Ended::How::Exited && WIFSIGNALED(status)) ended_.how = Ended::How::Signalled;
    ended_.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
    return ended_;
  }

 private:
  // In the new process: only system calls are safe here.
  [[noreturn]] static void become(const std::vector<char*>& arguments, int out, int err, pid_t parent) {
    setpgid(0, 0);  // a Ctrl-C of the terminal is for the parent, which ends us
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);
    const rlimit noCore{0, 0};
    setrlimit(RLIMIT_CORE, &noCore);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    execv(arguments[0], arguments.data());
    _exit(127);
  }

  static void append(Stream& stream, std::string& text) {
    char bytes[4096];
    while (stream.number() >= 0) {
      const ssize_t count = ::read(stream.number(), bytes, sizeof bytes);
      if (count > 0)
        text.append(bytes, static_cast<size_t>(count));
      else if (count == 0 || errno != EINTR) {
        if (count == 0 || errno != EAGAIN) stream.close();
        return;
      }
    }
  }

  const size_t index_;
  pid_t pid_ = 0;
  bool hasEnded_ = false;
  Stream process_{-1};
  Stream out_{-1};
  Stream err_{-1};
  Ended ended_;
  const Clock::time_point start_ = Clock::now();
};

// Waits until a child writes or ends, the first time limit is over, or the user interrupts: then true.
bool wait(std::list<Child>& children, double timeoutSeconds, int interruption) {
  std::vector<pollfd> streams = {{interruption, POLLIN, 0}};
  double left = timeoutSeconds;
  for (const Child& child : children) {
    for (const pollfd& stream : child.polled()) streams.push_back(stream);
    left = std::min(left, timeoutSeconds - child.seconds());
  }
  const int milliseconds = static_cast<int>(std::clamp(left, 0.0, 1e6) * 1000) + 1;
  if (poll(streams.data(), streams.size(), milliseconds) <= 0) return false;
  std::span<const pollfd> polled = std::span(streams).subspan(1);
  for (Child& child : children) {
    child.read(polled.first(3));
    polled = polled.subspan(3);
  }
  return streams.front().revents != 0;
}

}  // namespace

bool runCommands(const std::vector<Command>& commands, int jobs, double timeoutSeconds,
                 const std::function<void(size_t, const Ended&)>& onEnd) {
  const base::Interruption interruption({SIGINT, SIGTERM});
  std::list<Child> children;
  size_t started = 0;
  while (started < commands.size() || !children.empty()) {
    while (started < commands.size() && children.size() < static_cast<size_t>(std::max(jobs, 1))) {
      children.emplace_back(commands[started], started);
      ++started;
    }
    if (wait(children, timeoutSeconds, interruption.stream())) {
      for (Child& child : children) onEnd(child.index(), child.end(Ended::How::Interrupted));
      return false;
    }
    for (auto child = children.begin(); child != children.end();) {
      const bool late = !child->hasEnded() && child->seconds() >= timeoutSeconds;
      if (!child->hasEnded() && !late) {
        ++child;
        continue;
      }
      onEnd(child->index(), child->end(late ? Ended::How::TimedOut : Ended::How::Exited));
      child = children.erase(child);
    }
  }
  return true;
}

std::string thisProgram() {
  return "/proc/self/exe";
}

}  // namespace sfumato::lists::validation
