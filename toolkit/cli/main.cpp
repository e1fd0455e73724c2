#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <new>
#include <sstream>
#include <thread>

#include <spdlog/spdlog.h>

#include "plugins/c/plugins.h"
#include "samples/head/sample_operation.h"
#include "toolkit/cli/command_line.h"
#include "toolkit/cli/exit_code.h"
#include "toolkit/cli/manual.h"
#include "toolkit/cli/run_command.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/operation.h"
#include "toolkit/operations/this_process.h"

#ifdef MIMETRA_HAS_VTK
#include "toolkit/pictures/picture_formats.h"
#include "toolkit/report/report_operation.h"
#include "toolkit/vtk/vtk_formats.h"
#endif
#ifdef MIMETRA_HAS_FITTING
#include "fitting/fit_operation.h"
#endif
#ifdef MIMETRA_HAS_MPI
#include "toolkit/cli/mpi_ranks.h"
#endif

namespace {

/// Size of the last allocation that failed in the program's own code, in bytes. 0 if none failed,
/// or only allocations of third-party libraries.
std::atomic<std::size_t> failed_allocation = 0;

void* noted(void* memory, std::size_t bytes) {
  if (!memory) failed_allocation = bytes;
  return memory;
}

}  // namespace

// std::bad_alloc does not contain the requested size. The linker redirects the program's calls to
// these functions (--wrap, in CMakeLists.txt); __real_NAME is the original function.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the linker's names
extern "C" {
void* __real_malloc(std::size_t bytes);
void* __real_realloc(void* memory, std::size_t bytes);
void* __real__Znwm(std::size_t bytes);
void* __real__ZnwmSt11align_val_t(std::size_t bytes, std::align_val_t alignment);

void* __wrap_malloc(std::size_t bytes);
void* __wrap_malloc(std::size_t bytes) {
  return noted(__real_malloc(bytes), bytes);
}

void* __wrap_realloc(void* memory, std::size_t bytes);
void* __wrap_realloc(void* memory, std::size_t bytes) {
  return noted(__real_realloc(memory, bytes), bytes);
}

void* __wrap__Znwm(std::size_t bytes);
void* __wrap__Znwm(std::size_t bytes) {
  try {
    return __real__Znwm(bytes);
  } catch (const std::bad_alloc&) {
    failed_allocation = bytes;
    throw;
  }
}

void* __wrap__ZnwmSt11align_val_t(std::size_t bytes, std::align_val_t alignment);
void* __wrap__ZnwmSt11align_val_t(std::size_t bytes, std::align_val_t alignment) {
  try {
    return __real__ZnwmSt11align_val_t(bytes, alignment);
  } catch (const std::bad_alloc&) {
    failed_allocation = bytes;
    throw;
  }
}
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

namespace {

void set_level(const mimetra::cli::Request& request) {
  spdlog::set_level(request.quiet     ? spdlog::level::err
                    : request.verbose ? spdlog::level::info
                                      : spdlog::level::warn);
}

/// Parses the command line and warns about plugins that could not be added. The warnings precede an
/// error that they may explain. A line with --quiet suppresses them.
mimetra::cli::ParsedLine parse(const mimetra::OperationTable& table,
                               const std::vector<std::string>& arguments,
                               const std::vector<std::string>& left_out) {
  const auto warn = [&left_out] {
    for (const std::string& problem : left_out) spdlog::warn(mimetra::cli::terminal_text(problem));
  };
  try {
    mimetra::cli::ParsedLine line = mimetra::cli::parse_command_line(table, arguments);
    if (line.request) set_level(*line.request);
    warn();
    return line;
  } catch (...) {
    warn();
    throw;
  }
}

/// Adds the operations of all parts of this build.
void add_built(mimetra::OperationTable& table) {
  mimetra::add_toolkit(table);
  mimetra::add_markers(table);
#ifdef MIMETRA_HAS_VTK
  mimetra::add_vtk(table);
  mimetra::add_pictures(table);
  mimetra::add_report(table);
#endif
#ifdef MIMETRA_HAS_FITTING
  mimetra::add_fitting(table);
#endif
  mimetra::samples::add_sample(table);
  mimetra::add_listing(table);
  mimetra::cli::add_completion(table);
  mimetra::cli::add_manual(table);
}

void run(const std::vector<std::string>& arguments, const mimetra::Context& context) {
  mimetra::OperationTable table;
  add_built(table);
  const std::vector<std::string> left_out = mimetra::add_plugins(table, mimetra::plugin_folders());
  const mimetra::cli::ParsedLine line = parse(table, arguments, left_out);
  if (line.request) {
    mimetra::cli::run_command(table, *line.request, context);
  } else if (context.ranks().rank() == 0) {
    if (!(std::cout << line.text << std::flush)) {
      throw mimetra::OutputError("standard output", "cannot be written");
    }
  }
}

std::string memory_message() {
  const auto asked = static_cast<double>(failed_allocation);
  return "not enough memory: " +
         (asked > 0 ? mimetra::cli::megabytes(asked) + " more were asked for, and "
                    : std::string()) +
         mimetra::cli::megabytes(mimetra::MemoryUse::of_this_process().now) +
         " are held; take fewer frames with --frames";
}

/// A pipe, because signal handlers may write to one and do little else.
std::array<int, 2> interrupts = {-1, -1};

/// Waits until the pipe is readable, or without limit if `milliseconds` is -1.
void wait_for_interrupt(int milliseconds) {
  pollfd pipe{interrupts[0], POLLIN, 0};
  while (poll(&pipe, 1, milliseconds) < 0 && errno == EINTR) {
  }
}

/// Gives an interrupted run a moment to end at its next step. Then, or at a second interrupt,
/// removes temporary files and ends the process. Factorizations in libraries have no steps.
void end_after_interrupt() {
  constexpr int kMoment = 800;
  wait_for_interrupt(-1);
  char byte = 0;
  if (read(interrupts[0], &byte, 1) != 1) return;
  wait_for_interrupt(kMoment);
  mimetra::remove_pending_outputs();
  // Another thread may hold a lock of the streams now.
  constexpr std::string_view kText = "\nmimetra: error: cancelled\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kText.data(), kText.size());
  _exit(mimetra::cli::kInterrupted);
}

void handle_signal(int) {
  mimetra::cli::interrupt();
  if (write(interrupts[1], "!", 1) < 0) _exit(mimetra::cli::kInterrupted);
}

/// Installs handlers so that an interrupted run leaves no half-written output. Exceeding a limit on
/// file size is an error instead of a signal.
void take_signals() {
  if (pipe2(interrupts.data(), O_CLOEXEC | O_NONBLOCK) == 0) {
    std::thread(end_after_interrupt).detach();
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const auto before = std::signal(signal, handle_signal);
    if (before == SIG_IGN) std::signal(signal, SIG_IGN);  // as nohup sets it
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

/// Runs a command line, prints its error and returns the exit code.
int exit_code_of(const std::vector<std::string>& arguments, const mimetra::Context& context) {
  try {
    return mimetra::cli::exit_code_of([&] { run(arguments, context); });
  } catch (const std::bad_alloc&) {
    spdlog::error(memory_message());
    return mimetra::cli::kFailed;
  }
}

#ifdef MIMETRA_HAS_MPI
/// Runs as one of the processes that mpirun started; if one fails, all end.
int shared_exit_code(const std::vector<std::string>& arguments) {
  const mimetra::cli::MpiRanks ranks;
  mimetra::share_memory(ranks.on_this_machine());
  // Rank 0 reports errors that all processes have.
  const bool is_first = ranks.rank() == 0;
  std::ostringstream said;
  if (!is_first) mimetra::cli::say_to(said);
  const int code = exit_code_of(arguments, mimetra::Context().with_ranks(ranks));
  if (!is_first) mimetra::cli::say_to(std::cerr);
  if (code == mimetra::cli::kDone || ranks.count() == 1) return code;
  if (!is_first) {
    std::this_thread::sleep_for(std::chrono::seconds(2));
    std::cerr << said.str() << std::flush;
  }
  ranks.end_all(code);
}
#else
/// Whether mpirun started this process directly. Scripts under mpirun may start it as well, and
/// pass on their environment.
bool is_started_by_mpirun() {
  std::ifstream file("/proc/" + std::to_string(getppid()) + "/comm");
  std::string parent;
  std::getline(file, parent);
  const auto begins = [&parent](const char* name) { return parent.starts_with(name); };
  return std::ranges::any_of(std::array{"mpirun", "mpiexec", "orte", "hydra_pmi"}, begins);
}

/// Runs as the only process. If mpirun started several, each would write the same files.
int single_exit_code(const std::vector<std::string>& arguments) {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* processes = std::getenv(variable);
    if (!processes || std::atoi(processes) < 2 || !is_started_by_mpirun()) continue;
    spdlog::error(
        "mpirun started {} processes, and this build does the whole work in each; take the "
        "command that './dev build mpi' makes, or start each with its own work and without {}",
        processes, variable);
    return mimetra::cli::kUsage;
  }
  return exit_code_of(arguments, {});
}
#endif

/// Opens closed standard streams on /dev/null. Otherwise a file that is opened later would take
/// their place, and messages would be written into it. Writing to them fails as before.
void keep_standard_streams() {
  for (int stream = 0; stream <= 2; ++stream) {
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", O_RDONLY | O_CLOEXEC);
  }
}

}  // namespace

int main(int argc, char** argv) {
  keep_standard_streams();
  mimetra::cli::say_to(std::cerr);
  take_signals();
  const std::vector<std::string> arguments(argv + 1, argv + argc);
#ifdef MIMETRA_HAS_MPI
  return shared_exit_code(arguments);
#else
  return single_exit_code(arguments);
#endif
}
