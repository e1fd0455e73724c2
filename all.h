#pragma once

/// The library in one header, `#include <mimetra/all.h>`: values, algorithms and files. The folder
/// of each header below names its component: toolkit/io is mimetra::io.
///
/// Other headers need more than Eigen, such as toolkit/mesh/openmesh.h, or serve applications:
/// those of toolkit/operations, toolkit/vtk, toolkit/drawing, toolkit/pictures and fitting.

// The pipeline: what the command does, on values.
#include "toolkit/pipeline/measure.h"
#include "toolkit/pipeline/region_choice.h"
#include "toolkit/pipeline/retarget.h"
#include "toolkit/pipeline/rig.h"
#include "toolkit/pipeline/transfer.h"

// Meshes, sequences and fields.
#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/mesh/simplification.h"
#include "toolkit/mesh/subdivision.h"
#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/unit_change.h"
#include "toolkit/mesh/weld.h"

// Threads, progress, notes and errors of every computation.
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"

// Models with expressions and identities.
#include "toolkit/model/animation.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/model/retargeting.h"
#include "toolkit/model/weight_rules.h"

// Distances along a surface, sparse components, regions.
#include "geodesic/exact_geodesics.h"
#include "geodesic/heat_geodesics.h"
#include "geodesic/support_map.h"
#include "toolkit/regions/falloff.h"
#include "toolkit/regions/regions.h"
#include "toolkit/splocs/decomposition.h"

// Faces of another numbering or topology.
#include "toolkit/correspondence/automatic_markers.h"
#include "toolkit/correspondence/correspondence.h"
#include "toolkit/correspondence/pairing.h"
#include "toolkit/correspondence/renumbering.h"

// Transfer of deformation, and its error.
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/example_rig.h"
#include "toolkit/transfer/linear_transfer.h"
#include "toolkit/transfer/local_weights.h"
#include "toolkit/transfer/region_completion.h"
#include "toolkit/transfer/region_selection.h"
#include "toolkit/transfer/soft_border.h"
#include "toolkit/transfer/transfer_error.h"
#include "toolkit/transfer/vertex_transfer.h"

// Files. A library that was built with MIMETRA_FILES=OFF has none.
#if __has_include("toolkit/formats/sequence_file.h")
#include "toolkit/formats/gltf/gltf_write.h"
#include "toolkit/formats/hdf5/components_file.h"
#include "toolkit/formats/hdf5/vtkhdf_file.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/array_file.h"
#include "toolkit/io/correspondence_file.h"
#include "toolkit/io/live_link.h"
#include "toolkit/io/marker_file.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/painting_file.h"
#include "toolkit/io/regions_file.h"
#include "toolkit/io/retargeting_file.h"
#include "toolkit/io/rules_file.h"
#include "toolkit/io/weight_file.h"
#endif
