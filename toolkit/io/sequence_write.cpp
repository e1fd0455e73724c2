#include <stdexcept>

#include "toolkit/io/frame_sequence.h"
#include "toolkit/io/sequence_file.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/animation.h"

namespace mimetra {
namespace fs = std::filesystem;

std::unique_ptr<FrameSink> begin_sequence(const SequenceHeader& header, const fs::path& target,
                                          const SequenceWriteOptions& options,
                                          const ExtraFiles& extra, const Context& context) {
  check_options(options);
  if (header.times.size() == 0) throw std::invalid_argument("the sequence has no frames");
  if (target.extension().empty()) return begin_folder(header, target, options, extra, context);
  if (const SequenceFormat* format = sequence_format(target)) {
    return format->begin(header, target, options, extra, context);
  }
  throw std::invalid_argument(target.string() + ": no sequence can be written as '" +
                              target.extension().string() + "', expected " +
                              joined(sequence_extensions()) + "; a folder of this name is '" +
                              target.string() + "/'");
}

std::vector<fs::path> write_sequence(const FrameSource& sequence, const fs::path& target,
                                     const SequenceWriteOptions& options, const ExtraFiles& extra,
                                     const Context& context) {
  if (const auto* animation = dynamic_cast<const Animation*>(&sequence)) {
    const SequenceFormat* format = sequence_format(target);
    if (format && format->write_animation && animation->model().expressions().size() > 0) {
      check_options(options);
      return format->write_animation(*animation, target, options, extra, context);
    }
  }
  const auto sink = begin_sequence(sequence.header(), target, options, extra, context.part(0, 0));
  context.report(0);
  for_each_block(
      sequence, [&sink](int first, const Frames& poses) { sink->write(first, poses); },
      context.without_ranks());
  context.report(1);
  return sink->commit();
}

}  // namespace mimetra
