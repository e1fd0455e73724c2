#include "toolkit/operations/input_files.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string>

#include "toolkit/io/model_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/counted.h"
#include "toolkit/operations/file_hash.h"

namespace mimetra {

namespace {

/// As numbers that ranks send: a double holds 32 bits and not 64.
constexpr int kHalves = 2;
constexpr int kHalfBits = 32;

std::vector<double> numbers_of(const std::vector<std::filesystem::path>& files) {
  std::vector<double> numbers;
  numbers.reserve(kHalves * files.size());
  for (const auto& file : files) {
    const std::uint64_t hash = hash_of_ends(file);
    numbers.push_back(static_cast<double>(hash >> kHalfBits));
    numbers.push_back(static_cast<double>(hash & 0xffffffffu));
  }
  return numbers;
}

}  // namespace

std::vector<std::filesystem::path> input_files(const std::vector<std::filesystem::path>& inputs) {
  std::vector<std::filesystem::path> files;
  for (const auto& input : inputs) {
    const auto start = static_cast<std::ptrdiff_t>(files.size());
    std::error_code unreadable;
    if (!std::filesystem::is_directory(input, unreadable)) {
      files.push_back(input);
    } else if (is_model(input)) {
      std::ranges::copy(model_files(input), std::back_inserter(files));
    } else {
      for (const auto& entry : std::filesystem::recursive_directory_iterator(input)) {
        if (entry.is_regular_file(unreadable)) files.push_back(entry.path());
      }
    }
    std::sort(files.begin() + start, files.end());
  }
  return files;
}

void check_same_inputs(const std::vector<std::filesystem::path>& inputs, const Context& context) {
  const Ranks& ranks = context.ranks();
  if (ranks.count() == 1) return;
  const std::vector<std::filesystem::path> files = input_files(inputs);
  const std::vector<double> own = numbers_of(files);
  double count = static_cast<double>(own.size());
  ranks.broadcast(0, {&count, 1});
  std::vector<double> of_first = own;
  of_first.resize(static_cast<std::size_t>(count));
  ranks.broadcast(0, of_first);
  if (of_first == own) return;
  const std::string process = "process " + std::to_string(ranks.rank());
  if (of_first.size() != own.size()) {
    throw MismatchError(process + " reads " + counted(std::ssize(files), "file") + ", process 0 " +
                        std::to_string(of_first.size() / kHalves) +
                        "; all must see the same inputs");
  }
  const auto first = std::ranges::mismatch(own, of_first).in1 - own.begin();
  throw MismatchError(files[static_cast<std::size_t>(first / kHalves)].string() + ": " + process +
                      " reads another content than process 0; all must see the same inputs");
}

}  // namespace mimetra
