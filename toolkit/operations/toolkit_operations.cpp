#include "toolkit/operations/toolkit_operations.h"

#include "toolkit/formats/formats.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/operations/weight_tables.h"

namespace mimetra {

void add_toolkit(OperationTable& table) {
  for (Format format : formats()) {
    if (format.open) format.read = read_sequence_value;
    if (format.create) format.write = write_sequence_value;
    table.add(std::move(format));
  }
  add_weight_formats(table);
  table.add(info_operation());
  table.add(check_operation());
  table.add(align_operation());
  table.add(geodesic_operation());
  table.add(decompose_operation());
  table.add(regions_operation());
  table.add(transfer_operation());
  table.add(evaluate_operation());
  table.add(rig_operation());
  table.add(convert_operation());
  table.add(simplify_operation());
  table.add(subdivide_operation());
  table.add(retarget_operation());
}

}  // namespace mimetra
