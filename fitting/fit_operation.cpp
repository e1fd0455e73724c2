#include "fitting/fit_operation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "fitting/fit_pictures.h"
#include "fitting/landmark_fitter.h"
#include "fitting/landmark_input.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/product_blocking.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/formats.h"
#include "toolkit/operations/json.h"

namespace mimetra {

namespace {

std::vector<Parameter> fit_parameters() {
  return {
      {"mapping",
       ParameterKind::file,
       {},
       "vertex of each landmark (default: ibug_to_*.txt or landmarks68.txt in the model's "
       "folder)"},
      choice_parameter(
          "solver", FitOptions{}.solver,
          "joint: camera, shape and expressions together; alternating: in turn, as in the paper"),
      choice_parameter("shape", FitOptions{}.shape,
                       "one identity for the clip, or one in every frame"),
      {"iterations", ParameterKind::integer, std::int64_t{FitOptions{}.iterations},
       "iterations at most", "", 1, 1e6},
      {"tolerance", ParameterKind::number, FitOptions{}.tolerance,
       "it ends where an iteration lowers the energy by a smaller share", "", 0, 1},
      {"sigma",
       ParameterKind::number,
       {},
       "noise of the landmarks (default: 0.017485 of the face's RMS radius)",
       "pixels",
       1e-9,
       1e9},
      {"ridge",
       ParameterKind::number,
       {},
       "weight of squared expressions (default: 0.1 with more than ten of them, else 0)",
       "",
       0,
       1e9},
      {"smoothness", ParameterKind::number, FitOptions{}.smoothness,
       "time constant of smooth expressions", "seconds", 0, 1e6}};
}

FitOptions options_of(const Parameters& parameters) {
  FitOptions options;
  options.solver = parameters.choice<FitOptions::Solver>("solver");
  options.shape = parameters.choice<FitOptions::Shape>("shape");
  options.iterations = parameters.integer("iterations");
  options.tolerance = parameters.number("tolerance");
  options.sigma = parameters.optional_number("sigma");
  options.ridge = parameters.optional_number("ridge");
  options.smoothness = parameters.number("smoothness");
  return options;
}

LandmarkMapping mapping_of(const Invocation& invocation, const NamedData& model) {
  if (const auto file = invocation.parameters.optional_text("mapping")) {
    return read_landmark_mapping(*file);
  }
  const std::filesystem::path& path = model.origin.path;
  if (path.empty()) throw UsageError("--mapping: is needed for a model without a folder");
  return read_landmark_mapping(find_landmark_mapping(path));
}

FittedCoefficients coefficients_of(const MorphableModel& model, const Eigen::VectorXd& times,
                                   const std::vector<FrameFit>& frames) {
  const auto count = static_cast<Eigen::Index>(frames.size());
  FittedCoefficients fit;
  fit.identities = model.identities().names;
  fit.expressions = model.expressions().names;
  fit.times = times;
  fit.alpha.resize(count, model.identities().size());
  fit.beta.resize(count, model.expressions().size());
  fit.rms.resize(count);
  fit.landmarks.resize(count);
  fit.iterations.resize(count);
  for (Eigen::Index f = 0; f < count; ++f) {
    const FrameFit& frame = frames[static_cast<std::size_t>(f)];
    fit.alpha.row(f) = frame.alpha;
    fit.beta.row(f) = frame.beta;
    fit.cameras.push_back(frame.camera);
    fit.rms[f] = frame.rms;
    fit.landmarks[f] = frame.landmarks;
    fit.iterations[f] = frame.iterations;
  }
  return fit;
}

/// The fitted face without its camera; its rest pose is the person's neutral.
MeshSequence sequence_of(const MorphableModel& model, const FittedCoefficients& fit,
                         FitOptions::Shape shape) {
  const BlendshapeModel person = model.person(fit.identity());
  MeshSequence sequence = person.animate(fit.beta, fit.times);
  if (shape == FitOptions::Shape::clip) return sequence;
  Frames frames = sequence.positions();
  const Eigen::MatrixXd rest_of_identity = fit.alpha.rowwise() - fit.identity().transpose();
  fix_product_blocking();
  frames.noalias() += rest_of_identity * model.identities().displacements.transpose();
  return sequence.with_frames(std::move(frames));
}

struct FitSummary {
  double rms = 0;  ///< over all landmarks of all frames, pixels
  int worst = 0;   ///< frame of the largest RMS
  int iterations = 0;
  std::vector<int> unseen;
};

FitSummary summary_of(const FittedCoefficients& fit) {
  FitSummary summary;
  double squares = 0, count = 0, largest = -1;
  for (int f = 0; f < fit.frames(); ++f) {
    if (fit.landmarks[f] == 0) {
      summary.unseen.push_back(f);
      continue;
    }
    squares += fit.rms[f] * fit.rms[f] * fit.landmarks[f];
    count += fit.landmarks[f];
    if (fit.rms[f] > largest) summary.worst = f;
    largest = std::max(largest, fit.rms[f]);
    summary.iterations = std::max(summary.iterations, fit.iterations[f]);
  }
  summary.rms = std::sqrt(squares / count);
  return summary;
}

/// Calls what may find that the landmarks contradict the model, and names them then.
template <typename Call>
auto naming_landmarks(const Invocation& invocation, Call call) {
  try {
    return call();
  } catch (const MismatchError& error) {
    throw MismatchError(invocation.input("landmarks").name + ": " + error.what());
  }
}

std::vector<FrameFit> fitted(const Invocation& invocation, const MorphableModel& model,
                             const MappedLandmarks& mapped, FitOptions options) {
  options.progress = part_of(invocation.progress, 0, 0.5);
  const Eigen::VectorXd& times = invocation.get<LandmarkTrack>("landmarks").times;
  return naming_landmarks(invocation, [&] {
    return LandmarkFitter(model, mapped.vertices).fit(mapped.points, options, times);
  });
}

/// Before anything is computed: pictures need what they are drawn on, and that it is sound.
void check_images(const Invocation& invocation) {
  const NamedData& landmarks = invocation.input("landmarks");
  for (const char* output : {"overlay", "strip"}) {
    if (!invocation.wants(output)) continue;
    if (landmarks.origin.images.empty()) {
      throw UsageError("--" + std::string(output) + ": " + landmarks.name +
                       " has no images; name them by --images");
    }
    for (const auto& image : landmarks.origin.images) check_image(image);
  }
}

std::vector<int> seen_frames(const FittedCoefficients& fit) {
  std::vector<int> frames;
  for (int f = 0; f < fit.frames(); ++f) {
    if (fit.landmarks[f] > 0) frames.push_back(f);
  }
  return frames;
}

Outcome run(const Invocation& invocation) {
  const NamedData& landmarks = invocation.input("landmarks");
  const LandmarkTrack& track = std::get<LandmarkTrack>(landmarks.data);
  const MorphableModel& model = invocation.get<ModelData>("model").model;
  check_images(invocation);
  const FitOptions options = options_of(invocation.parameters);
  const LandmarkMapping mapping = mapping_of(invocation, invocation.input("model"));
  const MappedLandmarks mapped =
      naming_landmarks(invocation, [&] { return map_landmarks(track, mapping); });
  report_progress(invocation.progress, 0);
  FittedCoefficients fit =
      coefficients_of(model, track.times, fitted(invocation, model, mapped, options));
  fit.notes = landmarks.origin.frame_notes;
  report_progress(invocation.progress, 0.5);

  const FitSummary summary = summary_of(fit);
  if (!summary.unseen.empty()) {
    invocation.warn(landmarks.name +
                    ": frames of the result without landmarks, whose face lies between those of "
                    "their neighbours: " +
                    listed(words_of(summary.unseen)));
  }
  const MeshSequence sequence = sequence_of(model, fit, options.shape);
  Outcome outcome;
  Json report = {{"rms_px", summary.rms},
                 {"vertices", model.vertices()},
                 {"mapped_landmarks", mapped.vertices.size()},
                 {"unseen_frames", summary.unseen}};
  report.update(Json::parse(fit_json(fit)));
  outcome.report = report.dump();
  outcome.summary =
      std::to_string(fit.frames()) + " frames, " + std::to_string(mapped.vertices.size()) + " of " +
      std::to_string(track.landmarks()) + " landmarks mapped: RMS " + readable(summary.rms) +
      " px (worst " + readable(fit.rms[summary.worst]) + " in frame " +
      std::to_string(summary.worst) + "), " + std::to_string(summary.iterations) + " iterations\n";
  outcome.outputs["out"].push_back({"", FieldSequence(sequence), {.model_driven = true}});
  outcome.outputs["fit-out"].push_back({"", fit});
  if (invocation.wants("overlay") || invocation.wants("strip")) {
    const FitPictures pictures(landmarks.origin.images, sequence, fit.cameras, mapped);
    if (invocation.wants("overlay")) {
      outcome.outputs["overlay"].push_back(
          {"", Pictures{fit.frames(), [pictures](int f) { return pictures.overlay(f); }}});
    }
    if (invocation.wants("strip")) {
      outcome.outputs["strip"].push_back({"", Pictures::of(pictures.strip(seen_frames(fit)))});
    }
  }
  return outcome;
}

LandmarkReader landmark_reader() {
  LandmarkReader reader;
  reader.parameters = {
      {"images",
       ParameterKind::text,
       {},
       "images that landmarks from files belong to, for --overlay and --strip: a file, folder or "
       "pattern (default: of the same name beside .pts files)"},
      {"face-model",
       ParameterKind::file,
       {},
       "dlib's predictor of 68 landmarks (default: that of the package libdlib-data)"},
      {"min-confidence", ParameterKind::number, FaceOptions{}.min_confidence,
       "frames of which the detector was less sure are taken as not seen", "", 0, 1}};
  reader.read = [](const std::string& text, const SequenceSource& source,
                   const Parameters& parameters) {
    LandmarkInputOptions options;
    options.images = parameters.optional_text("images");
    options.faces.min_confidence = parameters.number("min-confidence");
    if (const auto model = parameters.optional_text("face-model")) options.faces.model = *model;
    return read_landmark_input(text, source, options);
  };
  return reader;
}

/// The sequence, and the person whose expressions are copied; with one identity for all frames also
/// the joint solver's system of each.
double memory(const Invocation& invocation) {
  const double frames = invocation.get<LandmarkTrack>("landmarks").frames();
  const MorphableModel& model = invocation.get<ModelData>("model").model;
  const double coordinates = 3.0 * model.vertices();
  const double unknowns = 8.0 + model.identities().size() + model.expressions().size();
  const bool each_frame =
      invocation.parameters.choice<FitOptions::Shape>("shape") == FitOptions::Shape::frame;
  return sizeof(double) *
         (coordinates * ((each_frame ? 2 : 1) * frames + 2 * model.expressions().size()) +
          (each_frame ? 0 : frames * unknowns * unknowns));
}

}  // namespace

void add_fitting(OperationTable& table) {
  Operation operation;
  operation.name = "fit";
  operation.summary = "Fit a morphable face model to 2D landmarks: a sequence in correspondence";
  operation.inputs = {{"landmarks", DataKind::landmarks,
                       "images of a face, .pts files (one of them, a folder, a pattern), or a .csv "
                       "or .json track"},
                      {"model", DataKind::model,
                       "model folder with identities and expressions, or eos shape model (.bin)",
                       false, false, true}};
  operation.outputs = {{"out", DataKind::sequence, sequence_outputs()},
                       {"fit-out", DataKind::fit,
                        "coefficients and cameras, .json (default: NAME.fit.json beside OUT), for "
                        "MODEL@NAME.fit.json",
                        true, false, ".fit.json"},
                       {"overlay", DataKind::pictures,
                        "folder of the images with mesh and landmarks drawn over them", true},
                       {"strip", DataKind::pictures,
                        "five of them in a row, near enough to judge the fit, .png", true}};
  operation.inputs.back().identities = true;
  operation.outputs[2].extensions = {""};
  operation.outputs[3].extensions = {".png"};
  operation.parameters = fit_parameters();
  operation.examples = {"fit face.png --model sfm/ -o face.obj --strip face_fit.png",
                        "fit track.csv --model sfm/ --smoothness 0.1 -o take/"};
  operation.run = run;
  operation.memory = memory;
  table.add(landmark_reader());
  table.add(std::move(operation));
}

}  // namespace mimetra
