#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/model/blendshape_model.h"

namespace mimetra::bench {

/// A performance of one person, and another person's expressions.
struct Subject {
  std::string name;
  MeshSequence performance;
  BlendshapeModel target;
  /// The target as the command takes it; empty where it is in no file.
  std::string target_text = {};
  /// What the target does in the performance, where its weights are known.
  std::optional<MeshSequence> truth = {};
};

/// The built-in head, its triangles split in four `splits` times, with its performance slowed down
/// or sped up to `frames` frames.
Subject head(int splits, int frames);

/// The models beside the project, where they are.
std::optional<Subject> surrey();  ///< 100 frames x 3448, 6 expressions
/// The first clip's six expressions moving in four quarters of the face at different times, which
/// weights of a whole face cannot follow.
std::optional<Subject> quartered_surrey();
std::optional<Subject> ict(int frames);  ///< x 6706, 53 expressions; at most 1200 frames

/// The first frames of ict() by a target that knows only expressions of both halves together, which
/// cannot follow a capture that is not symmetric.
std::optional<Subject> symmetric_ict(int frames);

std::optional<Subject> bent_facecap();  ///< 335 frames x 2694, 52 expressions; onto itself bent

/// The first frames.
Subject first_frames(const Subject& subject, int frames);

/// This share of the target's triangles, around the vertex that its expressions move most.
std::vector<int> triangles_around_motion(const Subject& subject, double share);

}  // namespace mimetra::bench
