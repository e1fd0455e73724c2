#include "toolkit/io/fit_file.h"

#include <cmath>
#include <limits>
#include <set>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

template <typename Row>
Json numbers_of(const Row& row) {
  Json list = Json::array();
  for (const double value : row) list.push_back(value);
  return list;
}

/// Reads values of a parsed file; errors contain the place of the value.
class FitReader {
 public:
  explicit FitReader(const std::filesystem::path& path)
      : path_(path.string()), root_(read_json(path)) {}

  FittedCoefficients read() {
    if (!root_.is_object()) fail("/", "expected the object that `mimetra fit` writes");
    fit_.identities = names("identities");
    fit_.expressions = names("expressions");
    if (!root_.contains("frames") || !root_["frames"].is_array() || root_["frames"].empty()) {
      fail("/frames", "expected a list of frames");
    }
    resize(static_cast<Eigen::Index>(root_["frames"].size()));
    for (Eigen::Index f = 0; f < fit_.alpha.rows(); ++f) read_frame(f);
    return std::move(fit_);
  }

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& message) const {
    throw IoError(path_, place + ": " + message);
  }

  std::vector<std::string> names(const std::string& key) const {
    const std::string place = "/" + key;
    if (!root_.contains(key) || !root_[key].is_array()) fail(place, "expected a list of names");
    std::vector<std::string> names;
    std::set<std::string> seen;
    for (const Json& name : root_[key]) {
      if (!name.is_string()) fail(place, "expected strings");
      names.push_back(name.get<std::string>());
      if (!seen.insert(names.back()).second) fail(place, "'" + names.back() + "' occurs twice");
    }
    return names;
  }

  void resize(Eigen::Index frames) {
    fit_.alpha.resize(frames, static_cast<Eigen::Index>(fit_.identities.size()));
    fit_.beta.resize(frames, static_cast<Eigen::Index>(fit_.expressions.size()));
    fit_.times.resize(frames);
    fit_.rms.resize(frames);
    fit_.landmarks.resize(frames);
    fit_.iterations.resize(frames);
    fit_.cameras.resize(static_cast<std::size_t>(frames));
  }

  const Json& member(const Json& frame, const std::string& key, const std::string& place) const {
    if (!frame.is_object() || !frame.contains(key)) fail(place + "/" + key, "is missing");
    return frame[key];
  }

  double number(const Json& value, const std::string& place) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      fail(place, "expected a finite number");
    }
    return value.get<double>();
  }

  int count(const Json& value, const std::string& place) const {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMostCounted) {
      fail(place, "expected a number of 0 or more");
    }
    return value.get<int>();
  }

  Eigen::RowVectorXd row(const Json& list, Eigen::Index size, const std::string& place) const {
    if (!list.is_array() || static_cast<Eigen::Index>(list.size()) != size) {
      fail(place, "expected " + std::to_string(size) + " numbers" +
                      (list.is_array() ? ", found " + std::to_string(list.size()) : ""));
    }
    Eigen::RowVectorXd row(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      row[i] = number(list[static_cast<std::size_t>(i)], place + "/" + std::to_string(i));
    }
    return row;
  }

  void read_frame(Eigen::Index f) {
    const std::string place = "/frames/" + std::to_string(f);
    const Json& frame = root_["frames"][static_cast<std::size_t>(f)];
    fit_.times[f] = number(member(frame, "time", place), place + "/time");
    if (f > 0 && fit_.times[f] <= fit_.times[f - 1]) fail(place + "/time", "times do not ascend");
    const Json& rms = member(frame, "rms_px", place);
    fit_.rms[f] =
        rms.is_null() ? std::numeric_limits<double>::quiet_NaN() : number(rms, place + "/rms_px");
    fit_.landmarks[f] = count(member(frame, "landmarks", place), place + "/landmarks");
    fit_.iterations[f] = count(member(frame, "iterations", place), place + "/iterations");
    fit_.alpha.row(f) = row(member(frame, "alpha", place), fit_.alpha.cols(), place + "/alpha");
    fit_.beta.row(f) = row(member(frame, "beta", place), fit_.beta.cols(), place + "/beta");
    const Json& camera = member(frame, "camera", place);
    if (!camera.is_array() || (camera.size() != 2 && camera.size() != 3)) {
      fail(place + "/camera", "expected two rows, or three of a perspective camera");
    }
    if (f == 0 && camera.size() == 3) fit_.depths.resize(fit_.alpha.rows(), 4);
    if ((camera.size() == 3) != (fit_.depths.rows() > 0)) {
      fail(place + "/camera", "expected as many rows as in the first frame");
    }
    if (camera.size() == 3) fit_.depths.row(f) = row(camera[2], 4, place + "/camera/2");
    for (int i = 0; i < 2; ++i) {
      fit_.cameras[static_cast<std::size_t>(f)].row(i) =
          row(camera[static_cast<std::size_t>(i)], 4, place + "/camera/" + std::to_string(i));
    }
  }

  static constexpr std::uint64_t kMostCounted = std::numeric_limits<int>::max();

  std::string path_;
  Json root_;
  FittedCoefficients fit_;
};

}  // namespace

Eigen::VectorXd FittedCoefficients::identity() const {
  if (has_one_identity()) return alpha.row(0);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(alpha.cols());
  int seen = 0;
  for (int f = 0; f < frames(); ++f) {
    if (landmarks[f] == 0) continue;
    sum += alpha.row(f);
    ++seen;
  }
  return seen > 0 ? Eigen::VectorXd(sum / seen) : Eigen::VectorXd(alpha.colwise().mean());
}

std::string fit_json(const FittedCoefficients& fit) {
  Json frames = Json::array();
  for (int f = 0; f < fit.frames(); ++f) {
    const auto& camera = fit.cameras[static_cast<std::size_t>(f)];
    Json frame = {{"time", fit.times[f]},
                  {"rms_px", std::isnan(fit.rms[f]) ? Json(nullptr) : Json(fit.rms[f])},
                  {"landmarks", fit.landmarks[f]},
                  {"iterations", fit.iterations[f]},
                  {"alpha", numbers_of(fit.alpha.row(f))},
                  {"beta", numbers_of(fit.beta.row(f))},
                  {"camera", {numbers_of(camera.row(0)), numbers_of(camera.row(1))}}};
    if (fit.depths.rows() > 0) frame["camera"].push_back(numbers_of(fit.depths.row(f)));
    if (fit.rms_all.size() > 0 && !std::isnan(fit.rms_all[f])) {
      frame["rms_px_all"] = fit.rms_all[f];
    }
    if (f < static_cast<int>(fit.notes.size()) && !fit.notes[static_cast<std::size_t>(f)].empty()) {
      frame["note"] = fit.notes[static_cast<std::size_t>(f)];
    }
    frames.push_back(std::move(frame));
  }
  return json_text(Json{{"identities", fit.identities},
                        {"expressions", fit.expressions},
                        {"frames", frames}},
                   1) +
         '\n';
}

FittedCoefficients read_fit(const std::filesystem::path& path) {
  return FitReader(path).read();
}

}  // namespace mimetra
