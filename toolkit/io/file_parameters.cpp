#include "toolkit/io/file_parameters.h"

#include <algorithm>

#include "toolkit/mesh/bound_parameters.h"

namespace mimetra {

namespace {

BoundParameters<ReadOptions> bound_for_reading() {
  BoundParameters<ReadOptions> list;
  return list
      .add("weights", ReadOptions::kWeights, "CSV or JSON of blendshape weights that drive a model")
      .brief("CSV or JSON of weights that drive a model")
      .add("weight-scale", ReadOptions::kWeightScale,
           "factor of the weights, as 0.01 for percent; without it, weights above 2 are refused")
      .add("topology", ReadOptions::kTopology, "mesh with the faces of a file that holds none")
      .add("frames", ReadOptions::kFrames, "part A:B:STEP of the frames, 0-based, B excluded")
      .brief("part A:B:STEP of the frames")
      .add("fps", ReadOptions::kFps, "frame rate of formats without times, as 30 or 24000/1001");
}

/// `of_folder`: with the format of its frames, whose choices are the mesh formats.
BoundParameters<WriteOptions> bound_for_writing(bool of_folder) {
  BoundParameters<WriteOptions> list;
  if (of_folder) {
    Parameter format{"format", ParameterKind::choice, WriteOptions().frame_format,
                     "format of frames in a folder"};
    for (const std::string& extension : mesh_extensions()) {
      format.choices.push_back(extension.substr(1));
    }
    list.add(std::move(format), [](const Parameters& parameters, WriteOptions& options) {
      options.frame_format = parameters.text("format");
    });
  }
  return list.add("double", WriteOptions::kDoublePrecision, "double precision in mesh files")
      .add("single", WriteOptions::kSinglePrecision, "single precision in .npy and .npz")
      .add("compress", WriteOptions::kCompression,
           "compression of .vtp: fast (LZ4) or small (zlib)");
}

template <typename Options>
std::vector<Parameter> named(const BoundParameters<Options>& bound,
                             const std::vector<std::string>& names) {
  std::vector<Parameter> parameters;
  for (const Parameter& parameter : bound.declared()) {
    if (std::ranges::find(names, parameter.name) != names.end()) parameters.push_back(parameter);
  }
  return parameters;
}

template <typename Options>
Options values_of(const BoundParameters<Options>& bound, const std::vector<Parameter>& declared,
                  const Parameters& parameters) {
  Options options;
  options.parameters = &parameters;
  for (const auto& entry : bound.entries()) {
    // Another format's parameter may have the name with another meaning.
    const bool is_declared = std::ranges::any_of(declared, [&entry](const Parameter& parameter) {
      return parameter.name == entry.parameter.name && parameter.kind == entry.parameter.kind;
    });
    if (is_declared) entry.apply(parameters, options, nullptr);
  }
  return options;
}

}  // namespace

std::vector<Parameter> reading_parameters(const std::vector<std::string>& names) {
  return named(bound_for_reading(), names);
}

std::vector<Parameter> writing_parameters(const std::vector<std::string>& names) {
  const bool of_folder = std::ranges::find(names, "format") != names.end();
  return named(bound_for_writing(of_folder), names);
}

ReadOptions read_options(const std::vector<Parameter>& declared, const Parameters& parameters) {
  return values_of(bound_for_reading(), declared, parameters);
}

WriteOptions write_options(const std::vector<Parameter>& declared, const Parameters& parameters) {
  const bool of_folder = std::ranges::find(declared, "format", &Parameter::name) != declared.end();
  return values_of(bound_for_writing(of_folder), declared, parameters);
}

}  // namespace mimetra
