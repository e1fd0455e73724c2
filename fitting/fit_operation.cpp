#include "fitting/fit_operation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "fitting/clip_fit.h"
#include "fitting/fit_checks.h"
#include "fitting/fit_verdict.h"
#include "fitting/image_files.h"
#include "fitting/landmark_file.h"
#include "fitting/landmark_input.h"
#include "fitting/landmark_mapping.h"
#include "fitting/overlay.h"
#include "fitting/video_file.h"
#include "toolkit/io/file_parameters.h"
#include "toolkit/io/format.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/bound_parameters.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/reports.h"

namespace mimetra {

namespace {

struct FitCall {
  /// Whether the fitted sequence turns as the head does in the images.
  enum class HeadTurns { drop, keep };

  FitOptions fit = {};
  HeadTurns head_motion = HeadTurns::drop;
  /// Vertex of each landmark; defaults to a file in the model's folder.
  std::optional<std::filesystem::path> mapping = {};

  static constexpr Option kMapping{"mapping", &FitCall::mapping};
  static constexpr Option kHeadMotion{"head_motion", &FitCall::head_motion};
};

/// Name of the choice on the command line.
constexpr std::string_view choice_name(FitCall::HeadTurns value) {
  switch (value) {
    case FitCall::HeadTurns::drop:
      return "drop";
    case FitCall::HeadTurns::keep:
      return "keep";
  }
  return {};
}

BoundParameters<FitCall> fit_parameters() {
  BoundParameters<FitOptions> fit;
  fit.add("solver", FitOptions::kSolver,
          "joint: camera, shape and expressions together; alternating: in turn, as in the paper")
      .add("shape", FitOptions::kShape, "one identity for the clip, or one in every frame")
      .add("iterations", FitOptions::kIterations,
           "iterations at most, after those in which a clip's noise is estimated")
      .add("tolerance", FitOptions::kTolerance,
           "it ends where an iteration lowers the energy by a smaller share")
      .add("sigma", FitOptions::kSigma,
           "noise of the landmarks (default: estimated from a clip; 0.017485 of the face's RMS "
           "radius in "
           "a picture, with --repeated 0 and by the alternating solver)")
      .add("repeated", FitOptions::kRepeated,
           "share of the landmarks' squared error that is the same in every frame: frames say so "
           "much less about the identity; 0 for frames that are independent (default: estimated)")
      .add("camera", FitOptions::kCamera,
           "orthographic: scaled orthographic (auto: for clips); affine: as in the paper; "
           "perspective: with --focal-length")
      .brief("model of the camera")
      .add("stretch", FitOptions::kStretch,
           "how much the orthographic and perspective cameras may stretch the image, as a standard "
           "deviation")
      .add("focal-length", FitOptions::kFocalLength, "of the perspective camera")
      .add("outliers", FitOptions::kOutliers,
           "landmarks far from the face in units of the clip's noise: resist them (auto: where "
           "noise is estimated), or trust all")
      .add("ridge", FitOptions::kRidge,
           "weight of squared expressions (default: 0.125 for each of them beyond ten)")
      .add("smoothness", FitOptions::kSmoothness, "time constant of smooth expressions")
      .brief("time constant of smooth expressions")
      .under("Fitting");
  BoundParameters<FitCall> list;
  return list
      .add("mapping", FitCall::kMapping,
           "vertex of each landmark (default: ibug_to_*.txt or landmarks68.txt in the model's "
           "folder)")
      .add("head-motion", FitCall::kHeadMotion,
           "keep: the sequence turns as the head does in the images; drop: it looks ahead")
      .add(&FitCall::fit, fit);
}

/// Throws UsageError if options contradict each other.
void check_fit(const FitOptions& options) {
  using Camera = FitOptions::Camera;
  if ((options.camera == Camera::perspective) != options.focal_length.has_value()) {
    throw UsageError(options.focal_length ? "--focal-length: is for --camera perspective"
                                          : "--camera: a perspective one needs --focal-length");
  }
  if (options.solver == FitOptions::Solver::joint) return;
  const auto refuse = [](const char* option) {
    throw UsageError(std::string(option) + ": is for --solver joint");
  };
  if (options.camera == Camera::orthographic || options.camera == Camera::perspective) {
    refuse("--camera");
  }
  if (options.outliers == FitOptions::Outliers::resist) refuse("--outliers");
  if (options.repeated.value_or(0) > 0) refuse("--repeated");
}

LandmarkMapping mapping_of(const FitCall& call, const NamedData& model) {
  if (call.mapping) return read_landmark_mapping(*call.mapping);
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
  fit.rms_all.resize(count);
  fit.landmarks.resize(count);
  fit.iterations.resize(count);
  for (Eigen::Index f = 0; f < count; ++f) {
    const FrameFit& frame = frames[static_cast<std::size_t>(f)];
    fit.alpha.row(f) = frame.alpha;
    fit.beta.row(f) = frame.beta;
    fit.cameras.push_back(frame.camera);
    if (!frame.depth.head<3>().isZero(0)) {
      fit.depths.conservativeResize(count, 4);
      fit.depths.row(f) = frame.depth;
    }
    fit.rms[f] = frame.rms;
    fit.rms_all[f] = frame.rms_all;
    fit.landmarks[f] = frame.landmarks;
    fit.iterations[f] = frame.iterations;
  }
  return fit;
}

/// Fitted face without its camera. Its rest pose is the person's neutral.
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
  double rms = 0;  ///< over all landmarks of all frames, in pixels
  int worst = 0;   ///< frame with the largest RMS
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

/// Calls a function and prefixes the landmarks' name to its MismatchError.
template <typename Call>
auto naming_landmarks(const Invocation& invocation, Call call) {
  try {
    return call();
  } catch (const MismatchError& error) {
    throw MismatchError(invocation.input("landmarks").name + ": " + error.what());
  }
}

/// Checks early that outputs with pictures have readable images to draw on.
void check_images(const Invocation& invocation) {
  const NamedData& landmarks = invocation.input("landmarks");
  for (const char* output : {"overlay", "strip"}) {
    if (!invocation.wants(output)) continue;
    if (!landmarks.origin.images) {
      throw UsageError("--" + std::string(output) + ": " + landmarks.name +
                       " has no images; name them by --images");
    }
    landmarks.origin.images->check();
  }
}

/// Removes the landmarks of partial_frames() from `mapped`, with a warning, and returns the frames.
std::vector<int> without_partial_frames(const Invocation& invocation, const MorphableModel& model,
                                        MappedLandmarks& mapped) {
  const std::vector<int> partial = partial_frames(model, mapped);
  if (partial.empty()) return partial;
  const auto seen = (mapped.points.row(partial.front()).array().isFinite()).count() / 2;
  invocation.warn(invocation.input("landmarks").name + ": " + std::to_string(partial.size()) +
                  " of " + std::to_string(mapped.points.rows()) +
                  " frames show too little of the face to tell how the head is turned (frame " +
                  std::to_string(partial.front()) + ": " + std::to_string(seen) + " of " +
                  std::to_string(mapped.vertices.size()) +
                  " landmarks); they are taken as not seen, and their face lies between those of "
                  "their neighbours: " +
                  listed(words_of(partial)));
  for (const int frame : partial) {
    mapped.points.row(frame).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return partial;
}

/// Warns if most heads are turned far: then the model probably has other axes.
void warn_of_axes(const std::vector<AffineCamera>& cameras, const Invocation& invocation) {
  constexpr double kFar = EIGEN_PI / 3;
  const auto is_far = [](const AffineCamera& camera) {
    return Eigen::AngleAxisd(head_rotation(camera)).angle() > kFar;
  };
  if (2 * std::ranges::count_if(cameras, is_far) <= static_cast<std::ptrdiff_t>(cameras.size())) {
    return;
  }
  invocation.warn(
      "--head-motion keep: heads are turned by more than 60 degrees in most frames of a model that "
      "is taken as one that looks along +z with y up; where it does not, a landmarks68.txt beside "
      "it, or a mapping that names eyes and mouth as iBUG does (37 to 68), says how it looks");
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
  if (model.identities().size() == 0 && model.expressions().size() == 0) {
    const NamedData& input = invocation.input("model");
    throw IoError(input.origin.path.empty() ? input.name : input.origin.path.string(),
                  "is no model: it has neither identities nor expressions");
  }
  check_images(invocation);
  const FitCall call = fit_parameters().read(invocation.parameters);
  check_fit(call.fit);
  if (track.frames() > 1) {
    warn_of_guessed_rate(invocation, landmarks.name, track.times_are_known);
  }
  const LandmarkMapping mapping = mapping_of(call, invocation.input("model"));
  MappedLandmarks mapped =
      naming_landmarks(invocation, [&] { return map_landmarks(track, mapping); });
  const std::filesystem::path& model_path = invocation.input("model").origin.path;
  if (!tell_axes(mapped.ibug) && !model_path.empty()) {
    mapped.ibug = landmarks_beside(model_path, model.vertices());
  }
  const Context& context = invocation.context;
  context.report(0);
  const ClipFit clip =
      naming_landmarks(invocation, [&] { return ClipFit(model, mapped, track.times, call.fit); });
  check_focal_length(call.fit, model, mapped, landmarks.origin.images.get());
  const std::vector<int> partial = without_partial_frames(invocation, model, mapped);
  const std::vector<FrameFit> frames =
      naming_landmarks(invocation, [&] { return clip.all(context.part(0, 0.3)); });
  FittedCoefficients fit = coefficients_of(model, track.times, frames);
  const ClipPeople people = people_in(clip, fit, context.part(0.3, 0.5));
  context.report(0.5);

  const FitSummary summary = summary_of(fit);
  std::vector<int> without;
  std::ranges::set_difference(summary.unseen, partial, std::back_inserter(without));
  if (!without.empty()) {
    invocation.warn(landmarks.name +
                    ": frames of the result without landmarks, whose face lies between those of "
                    "their neighbours: " +
                    listed(words_of(without)));
  }
  const MeshSequence sequence = sequence_of(model, fit, call.fit.shape);
  const std::vector<AffineCamera> cameras = cameras_at_origin(fit);
  const AvertedLandmarks averted(sequence, fit, mapped.vertices, cameras);
  averted.require_facing(landmarks.name);
  fit.notes = averted.notes(invocation);
  const Judgement judgement{verdict_of(model, fit.identity()),
                            residuals_of(sequence, fit, mapped),
                            stretch_of(cameras, fit),
                            model.identities().size() > 0,
                            people,
                            expression_use(fit.beta)};
  Outcome outcome;
  Json report = {{"rms_px", summary.rms},
                 {"vertices", model.vertices()},
                 {"mapped_landmarks", mapped.vertices.size()},
                 {"unseen_frames", summary.unseen},
                 {"partial_frames", partial},
                 {"outline_landmarks", mapped.outline.cols() / 2},
                 {"repeated", frames.front().repeated},
                 {"verdict", judgement.json(fit.expressions)}};
  report.update(Json::parse(fit_json(fit)));
  outcome.report = json_text(report);
  outcome.summary = std::to_string(fit.frames()) + " frames, " +
                    std::to_string(mapped.vertices.size()) + " of " +
                    std::to_string(track.landmarks()) + " landmarks mapped: RMS " +
                    readable(summary.rms) + " px (worst " + readable(fit.rms[summary.worst]) +
                    " in frame " + std::to_string(summary.worst) + "), " +
                    std::to_string(summary.iterations) + " iterations\n" + judgement.words();
  warn_of(judgement, fit.expressions, mapped, call.fit, invocation);
  const bool turns = call.head_motion == FitCall::HeadTurns::keep;
  if (turns && !tell_axes(mapped.ibug)) warn_of_axes(cameras, invocation);
  outcome.outputs["out"].push_back(
      {"",
       FieldSequence(turns ? turned_as_seen(sequence, cameras, mapped.ibug) : sequence),
       {.model_driven = !turns}});
  outcome.outputs["fit-out"].push_back({"", fit});
  if (invocation.wants("landmarks-out")) outcome.outputs["landmarks-out"].push_back({"", track});
  if (invocation.wants("overlay") || invocation.wants("strip")) {
    const FitPictures pictures(landmarks.origin.images, sequence, fit, mapped);
    if (invocation.wants("overlay")) {
      const std::filesystem::path sound = landmarks.origin.images->sound();
      for (const auto& target : invocation.wanted.at("overlay")) {
        const std::string loss = lost_sound(target, sound);
        if (!loss.empty()) invocation.warn(loss);
      }
      outcome.outputs["overlay"].push_back(
          {"", Pictures{fit.frames(), [pictures](int f) { return pictures.overlay(f); }, fit.times,
                        sound}});
    }
    if (invocation.wants("strip")) {
      outcome.outputs["strip"].push_back({"", Pictures::of(pictures.strip(seen_frames(fit)))});
    }
  }
  return outcome;
}

BoundParameters<LandmarkInputOptions> landmark_parameters() {
  BoundParameters<FaceOptions> faces;
  faces
      .add("face-model", FaceOptions::kModel,
           "dlib's predictor of 68 landmarks (default: that of the package libdlib-data)")
      .add("min-confidence", FaceOptions::kMinConfidence,
           "frames of which the detector was less sure are taken as not seen");
  BoundParameters<LandmarkInputOptions> list;
  return list
      .add(
          "images", LandmarkInputOptions::kImages,
          "what landmarks from files belong to, for --overlay and --strip: a video, or an image, a "
          "folder or pattern of them (default: those of the same name beside .pts files)")
      .add("image-size", LandmarkInputOptions::kImageSize,
           "WIDTHxHEIGHT of the images of landmarks in shares of them, as MediaPipe's (default: "
           "that of --images)")
      .add(&LandmarkInputOptions::faces, faces);
}

ReadValue read_landmark_data(const std::string& text, const ReadOptions& options,
                             const Context& context) {
  const auto own = landmark_parameters();
  LandmarksRead read = read_landmark_input(
      text, options,
      own.read(options.parameters ? *options.parameters : Parameters(own.declared())), context);
  Origin origin;
  origin.images = std::move(read.images);
  origin.frame_notes = std::move(read.frame_notes);
  return {{text, std::move(read.track), std::move(origin)},
          std::move(read.files),
          std::move(read.notes)};
}

Format::Paths write_landmark_data(const Data& data, const std::filesystem::path& target,
                                  const WriteOptions& options, const Context&) {
  return write_text(target, options, landmark_csv(std::get<LandmarkTrack>(data)));
}

void add_landmark_formats(OperationTable& table) {
  std::vector<Parameter> reading = reading_parameters({"frames", "fps"});
  for (Parameter& parameter : landmark_parameters().declared()) {
    reading.push_back(std::move(parameter));
  }
  const auto add = [&](std::string name, std::vector<std::string> extensions,
                       decltype(Format::write) write = {}) {
    table.add(Format{.name = std::move(name),
                     .kind = DataKind::landmarks,
                     .extensions = std::move(extensions),
                     .reading = reading,
                     .read = read_landmark_data,
                     .write = std::move(write)});
  };
  add("image of a face", image_extensions());
  add("video of a face", video_extensions());
  add("points of iBUG", {".pts"});
  add("track of OpenFace, or a row for each frame", {".csv"}, write_landmark_data);
  add("track of frames and their points", {".json"});
  add("folder of images or of .pts files", {Format::kFolder});
}

/// Memory of the sequence and of the person with its copied expressions. One identity for all
/// frames adds the joint solver's system of each frame.
double memory(const Invocation& invocation) {
  const double frames = invocation.get<LandmarkTrack>("landmarks").frames();
  const MorphableModel& model = invocation.get<ModelData>("model").model;
  const double coordinates = 3.0 * model.vertices();
  const double unknowns = 8.0 + model.identities().size() + model.expressions().size();
  const FitCall call = fit_parameters().read(invocation.parameters);
  const bool each_frame = call.fit.shape == FitOptions::Shape::frame;
  return sizeof(double) *
         (coordinates * ((each_frame ? 2 : 1) * frames + 2 * model.expressions().size()) +
          (each_frame ? 0 : frames * unknowns * unknowns));
}

}  // namespace

void add_fitting(OperationTable& table) {
  Operation operation;
  operation.name = "fit";
  operation.summary = "Fit a morphable face model to 2D landmarks";
  operation.inputs = {
      {"landmarks", DataKind::landmarks,
       "images of a face, a video, or landmarks that were found: one file, a track, a folder, a "
       "pattern"},
      {"model", DataKind::model, "model with identities and expressions", false, false, true}};
  operation.outputs = {
      {"out", DataKind::sequence, "the fitted sequence"},
      {"fit-out", DataKind::fit,
       "coefficients and cameras, for MODEL@NAME.fit.json (default: NAME.fit.json beside "
       "OUT)",
       true, false, ".fit.json"},
      {"landmarks-out", DataKind::landmarks, "what was found, to start from another time", true},
      {"overlay", DataKind::pictures,
       "the images with mesh and landmarks drawn over them, as a video or in a folder", true},
      {"strip", DataKind::pictures, "five of them in a row, near enough to judge the fit", true}};
  operation.inputs.back().identities = true;
  operation.outputs[2].extensions = {".csv"};
  operation.outputs[3].extensions = {"", ".mp4", ".mov", ".mkv"};
  operation.outputs[4].extensions = {".png"};
  operation.parameters = fit_parameters().declared();
  operation.examples = {"fit face.png --model sfm/ -o face.obj --strip face_fit.png",
                        "fit take.mp4 --model sfm/ -o take/ --landmarks-out track.csv"};
  operation.run = run;
  operation.memory = memory;
  add_landmark_formats(table);
  add_video_format(table);
  table.add(std::move(operation));
  if (faces_can_be_found()) table.add(landmarks_of_drawings());
}

}  // namespace mimetra
