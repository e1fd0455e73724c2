#include "toolkit/splocs/motion.h"

#include <gtest/gtest.h>

namespace mimetra::test {
namespace {

/// Two whole blocks and a rest, of 3 rows, each with its number in all places.
class ScratchTest : public testing::Test {
 protected:
  using Block = KeptBlocks<double>::Block;

  ScratchTest() {
    for (int b = 0; b < blocks_->count(); ++b) blocks_->put(b, numbered(b));
  }

  Block numbered(int b) const { return Block::Constant(3, 3 * blocks_->size(b), b); }

  std::unique_ptr<KeptBlocks<double>> blocks_ =
      kept_blocks<double>(MotionPlace::scratch, 3, VertexPart(2 * VertexPart::kBlock + 5));
};

TEST_F(ScratchTest, BlocksThatAreHeldKeepTheirNumbers) {
  const auto first = blocks_->block(0), second = blocks_->block(1), rest = blocks_->block(2);
  EXPECT_EQ(*first, numbered(0));
  EXPECT_EQ(*second, numbered(1));
  EXPECT_EQ(*rest, numbered(2));
  const Block expected = numbered(0);
  blocks_.reset();
  EXPECT_EQ(*first, expected);
}

TEST_F(ScratchTest, MemoryServesTheNextBlockOfItsShape) {
  const double* const memory = blocks_->block(0)->data();
  EXPECT_NE(blocks_->block(2)->data(), memory);
  EXPECT_EQ(blocks_->block(1)->data(), memory);
}

TEST_F(ScratchTest, WhatChangesABlockIsKept) {
  blocks_->change(1, [](Block& block) { block *= 7; });
  EXPECT_EQ(*blocks_->block(0), numbered(0));
  EXPECT_EQ(*blocks_->block(1), 7 * numbered(1));
}

}  // namespace
}  // namespace mimetra::test
