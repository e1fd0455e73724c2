#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/weight_file.h"

namespace mimetra::test {

/// What a run of the command gave.
struct CommandResult {
  int code;
  std::string out;
  std::string err;
};

/// A folder of its own for each test, with a small model and a performance of it.
class CommandTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "mimetra-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    const WeightTrack track = performance();
    write_model(folder_ / "head", model(), track);
    write_weights(folder_ / "take.csv", track, false);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Runs `PREFIX mimetra ARGUMENTS` in the test's folder; both are the shell's words.
  CommandResult run(const std::string& arguments, const std::string& prefix = "") const {
    const auto out = folder_ / ".out", err = folder_ / ".err";
    const std::string line = "cd '" + folder_.string() + "' && { " + prefix + ' ' +
                             MIMETRA_COMMAND + ' ' + arguments + "; } > .out 2> .err < /dev/null";
    const int status = std::system(line.c_str());
    const CommandResult result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out),
                               text_of(err)};
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return result;
  }

  std::set<std::string> listing(const std::filesystem::path& below = {}) const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / below)) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

  static std::string text_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  void write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name) << content;
  }

  /// A curved patch of 15 x 15 vertices with three bumps and one identity that stretches it.
  static MorphableModel model() {
    Shape shape = grid(15, 15);
    const int n = static_cast<int>(shape.positions.rows());
    for (int v = 0; v < n; ++v) {
      shape.positions(v, 2) = 0.02 * std::pow(shape.positions(v, 0) - 7, 2);
    }
    Eigen::MatrixXd bumps = Eigen::MatrixXd::Zero(3 * n, 3);
    const double centers[3][2] = {{3, 3}, {11, 4}, {6, 11}};
    for (int j = 0; j < 3; ++j) {
      for (int v = 0; v < n; ++v) {
        const double x = shape.positions(v, 0) - centers[j][0];
        const double y = shape.positions(v, 1) - centers[j][1];
        const double r2 = (x * x + y * y) / 9;
        if (r2 < 1) bumps(3 * v + 2, j) = std::pow(1 - r2, 2);
      }
    }
    Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(3 * n, 1);
    for (int v = 0; v < n; ++v) wide(3 * v, 0) = 0.2 * shape.positions(v, 0);
    return MorphableModel(
        std::make_shared<Connectivity>(Connectivity::from_triangles(n, shape.triangles)),
        shape.positions, {{"wide"}, wide}, {{"left", "right", "top"}, bumps});
  }

  /// 12 frames; the first is neutral.
  static WeightTrack performance() {
    WeightTrack track{{"left", "right", "top"}, Eigen::MatrixXd(12, 3), Eigen::VectorXd(12)};
    for (int f = 0; f < 12; ++f) {
      track.times[f] = f / 25.0;
      for (int j = 0; j < 3; ++j) {
        track.weights(f, j) = std::pow(std::sin(0.5 * f * (j + 1)), 2);
      }
    }
    return track;
  }

  std::filesystem::path folder_;
};

}  // namespace mimetra::test
