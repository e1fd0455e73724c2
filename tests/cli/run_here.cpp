#include "tests/cli/run_here.h"

#include <algorithm>
#include <array>
#include <iostream>
#include <iterator>
#include <memory>
#include <sstream>
#include <vector>

#include <spdlog/spdlog.h>

#include "fitting/fit_operation.h"
#include "samples/head/sample_operation.h"
#include "toolkit/cli/exit_code.h"
#include "toolkit/cli/run_command.h"
#include "toolkit/operations/operation.h"

namespace mimetra::test {

namespace {

const OperationTable& linked_operations() {
  static const OperationTable table = [] {
    OperationTable linked;
    add_toolkit(linked);
    add_markers(linked);
    add_fitting(linked);
    samples::add_sample(linked);
    return linked;
  }();
  return table;
}

std::vector<std::string> words_of(const std::string& arguments) {
  std::istringstream stream(arguments);
  return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
}

/// Takes what is said on standard output and error, in another working folder.
class Surroundings {
 public:
  explicit Surroundings(const std::filesystem::path& folder)
      : folder_before_(std::filesystem::current_path()), logger_before_(spdlog::default_logger()) {
    std::filesystem::current_path(folder);
    out_before_ = std::cout.rdbuf(out_.rdbuf());
    err_before_ = std::cerr.rdbuf(err_.rdbuf());
    cli::say_to(err_);
  }
  ~Surroundings() {
    spdlog::set_default_logger(logger_before_);
    std::cerr.rdbuf(err_before_);
    std::cout.rdbuf(out_before_);
    std::cout.clear();
    std::filesystem::current_path(folder_before_);
  }
  Surroundings(const Surroundings&) = delete;
  Surroundings& operator=(const Surroundings&) = delete;

  std::string out() const { return out_.str(); }
  std::string err() const { return err_.str(); }

 private:
  std::ostringstream out_, err_;
  std::filesystem::path folder_before_;
  std::shared_ptr<spdlog::logger> logger_before_;
  std::streambuf* out_before_ = nullptr;
  std::streambuf* err_before_ = nullptr;
};

void answer(const std::vector<std::string>& arguments) {
  spdlog::set_level(spdlog::level::warn);
  cli::ParsedLine line = cli::parse_command_line(linked_operations(), arguments);
  if (!line.request) {
    std::cout << line.text;
    return;
  }
  if (line.request->quiet) spdlog::set_level(spdlog::level::err);
  if (line.request->verbose) spdlog::set_level(spdlog::level::info);
  line.request->progress = cli::ProgressBar::never;
  cli::run_command(linked_operations(), *line.request);
}

}  // namespace

bool can_run_here(const std::string& arguments) {
  if (arguments.find_first_of("'\"\\*?[]{}~$&|;<>()`#!") != std::string::npos) return false;
  static constexpr std::array kElsewhere = {".vtp",   ".VTP",      ".pvd",       ".png",
                                            ".mp4",   "--overlay", "--strip",    "--paraview",
                                            "--help", " -h",       "--progress", "--compress"};
  const auto is_named = [&arguments](const char* part) {
    return arguments.find(part) != std::string::npos;
  };
  if (std::ranges::any_of(kElsewhere, is_named)) return false;
  const std::vector<std::string> words = words_of(arguments);
  return !words.empty() && linked_operations().find(words.front()) != nullptr;
}

CommandResult run_here(const std::filesystem::path& folder, const std::string& arguments) {
  const Surroundings surroundings(folder);
  const int code = cli::exit_code_of([&] { answer(words_of(arguments)); });
  return {code, surroundings.out(), surroundings.err()};
}

}  // namespace mimetra::test
