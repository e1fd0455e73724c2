#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "toolkit/mesh/mesh_sequence.h"

/// Real captures driven on real models, read with the least that does it: these tests stand below
/// the library that reads files.
namespace mimetra::test {

/// The `v` and `f` lines of an OBJ file.
inline TriMesh read_plain_obj(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<double> coordinates;
  Polygons polygons;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind, word;
    words >> kind;
    while ((kind == "v" || kind == "f") && words >> word) {
      if (kind == "v") coordinates.push_back(std::stod(word));
      // `f 3/1 ...`: std::stoi stops at the slash.
      if (kind == "f") polygons.corners.push_back(std::stoi(word) - 1);
    }
    if (kind == "f") polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
  }
  const int vertices = static_cast<int>(coordinates.size() / 3);
  return {PositionsView(coordinates.data(), vertices, 3),
          Connectivity::from_polygons(vertices, std::move(polygons))};
}

/// Columns `names` and rows of a weights CSV.
struct Track {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
};

inline Track read_track(const std::filesystem::path& path, int rows) {
  std::ifstream file(path);
  Track track;
  std::string line, word;
  std::getline(file, line);
  for (std::istringstream words(line); std::getline(words, word, ',');) track.names.push_back(word);
  while (static_cast<int>(track.rows.size()) < rows && std::getline(file, line)) {
    std::vector<double>& row = track.rows.emplace_back();
    for (std::istringstream words(line); std::getline(words, word, ',');) {
      row.push_back(std::stod(word));
    }
  }
  return track;
}

/// `browDownLeft` drives `browDown_L`; `cheekPuff` drives both halves.
inline std::vector<std::string> driven_shapes(const std::string& name) {
  for (const auto& [side, suffix] :
       {std::pair<std::string, std::string>{"Left", "_L"}, {"Right", "_R"}}) {
    if (name.ends_with(side)) return {name, name.substr(0, name.size() - side.size()) + suffix};
  }
  return {name, name + "_L", name + "_R"};
}

/// The first frames of a capture on a model: neutral + sum of weight x (shape - neutral), its rest
/// pose the neutral.
inline MeshSequence captured_performance(const std::filesystem::path& neutral_file,
                                         const std::filesystem::path& shapes,
                                         const std::filesystem::path& weights, int frames) {
  const TriMesh neutral = read_plain_obj(neutral_file);
  const Track track = read_track(weights, frames);
  const Eigen::Map<const Eigen::RowVectorXd> rest(neutral.positions.data(),
                                                  neutral.positions.size());
  Frames poses = rest.replicate(static_cast<int>(track.rows.size()), 1);
  for (std::size_t column = 0; column < track.names.size(); ++column) {
    for (const std::string& shape : driven_shapes(track.names[column])) {
      const auto file = shapes / (shape + ".obj");
      if (!std::filesystem::exists(file)) continue;
      const Positions displacement = read_plain_obj(file).positions - neutral.positions;
      for (std::size_t f = 0; f < track.rows.size(); ++f) {
        poses.row(f) +=
            track.rows[f][column] * displacement.reshaped<Eigen::RowMajor>().transpose();
      }
    }
  }
  return {neutral.connectivity, std::move(poses), {}, neutral.positions};
}

}  // namespace mimetra::test
