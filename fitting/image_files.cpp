#include "fitting/image_files.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "fitting/orientation.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/image_decoder.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

constexpr Color kWhite = {255, 255, 255};

void check_pixels(const Image& image) {
  if (image.pixels.empty()) throw std::invalid_argument("the image has no pixels");
}

/// Colours of a decoded picture. Opacity is dropped.
struct ColorImage : PixelSink {
  void begin(const PictureSize& size) override {
    image = Image(static_cast<int>(size.width), static_cast<int>(size.height));
  }
  void take(std::uint64_t row, std::uint64_t column, std::uint64_t step,
            std::span<const std::uint16_t> rgba) override {
    const auto in_8_bits = [](std::uint16_t value) {
      return static_cast<std::uint8_t>((value + 128U) / 257U);
    };
    for (; !rgba.empty(); rgba = rgba.subspan(4), column += step) {
      image.at(static_cast<int>(column), static_cast<int>(row)) = {
          in_8_bits(rgba[0]), in_8_bits(rgba[1]), in_8_bits(rgba[2])};
    }
  }

  Image image;
};

/// Source pixels from `first` to before `last` that a target pixel covers; at least one.
struct Span {
  int first;
  int last;
};

Span covered(int target, int targets, int sources) {
  const auto edge = [&](int at) {
    return static_cast<int>(static_cast<long long>(at) * sources / targets);
  };
  return {edge(target), std::max(edge(target + 1), edge(target) + 1)};
}

Color mean_color(const Image& image, const Span& columns, const Span& rows) {
  long long red = 0, green = 0, blue = 0;
  for (int y = rows.first; y < rows.last; ++y) {
    for (int x = columns.first; x < columns.last; ++x) {
      const Color& pixel = image.at(x, y);
      red += pixel.red;
      green += pixel.green;
      blue += pixel.blue;
    }
  }
  const long long count =
      static_cast<long long>(columns.last - columns.first) * (rows.last - rows.first);
  const auto mean = [count](long long sum) {
    return static_cast<std::uint8_t>((sum + count / 2) / count);
  };
  return {mean(red), mean(green), mean(blue)};
}

/// Copies `source` into `target`, with its upper left corner at column `left` of the first row.
void paste(const Image& source, int left, Image& target) {
  for (int y = 0; y < source.height; ++y) {
    std::copy_n(&source.at(0, y), source.width, &target.at(left, y));
  }
}

}  // namespace

std::vector<std::string> image_extensions() {
  return {".png", ".jpg", ".jpeg"};
}

bool is_image(const std::filesystem::path& path) {
  const std::vector<std::string> known = image_extensions();
  return std::ranges::find(known, lower_extension(path)) != known.end();
}

std::vector<std::filesystem::path> image_files(const std::string& text) {
  std::error_code missing;
  const bool is_folder = std::filesystem::is_directory(text, missing);
  if (!is_folder && std::filesystem::exists(text, missing)) return {text};
  if (!is_folder && !is_frame_pattern(text)) fail_missing(text);
  std::vector<std::filesystem::path> files = files_named(text);
  std::erase_if(files, std::not_fn(is_image));
  if (files.empty()) {
    throw IoError(text, std::string(is_folder ? "holds" : "matches") + " no PNG or JPEG file");
  }
  return files;
}

Image read_image(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  ColorImage pixels;
  decode_picture(path.string(), bytes, pixels);
  return oriented(std::move(pixels.image), orientation_of_exif(exif_orientation(bytes)));
}

void ImageFiles::check() const {
  for (const std::filesystem::path& path : files_) {
    picture_size(path.string(), read_file(path));
  }
}

Image cropped(const Image& image, int left, int top, int width, int height) {
  const auto limited = [](long long value, int size) {
    return static_cast<int>(std::clamp<long long>(value, 0, size));
  };
  const Span columns = {limited(left, image.width),
                        limited(static_cast<long long>(left) + width, image.width)};
  const Span rows = {limited(top, image.height),
                     limited(static_cast<long long>(top) + height, image.height)};
  if (columns.first >= columns.last || rows.first >= rows.last) {
    throw std::invalid_argument("nothing of the part asked for is inside the image");
  }
  Image part(columns.last - columns.first, rows.last - rows.first, kWhite);
  for (int y = 0; y < part.height; ++y) {
    std::copy_n(&image.at(columns.first, rows.first + y), part.width, &part.at(0, y));
  }
  return part;
}

Image scaled_to_height(const Image& image, int height) {
  check_pixels(image);
  if (height < 1) throw std::invalid_argument("the height must be at least 1");
  const double scale = double(height) / image.height;
  Image scaled(std::max(1, static_cast<int>(std::lround(scale * image.width))), height, kWhite);
  for (int y = 0; y < height; ++y) {
    const Span rows = covered(y, height, image.height);
    for (int x = 0; x < scaled.width; ++x) {
      scaled.at(x, y) = mean_color(image, covered(x, scaled.width, image.width), rows);
    }
  }
  return scaled;
}

Image strip(const std::vector<Image>& images, int height, int gap) {
  if (images.empty()) throw std::invalid_argument("a strip needs an image");
  if (height < 0 || gap < 0) throw std::invalid_argument("height and gap must not be negative");
  std::ranges::for_each(images, check_pixels);
  if (height == 0) height = std::ranges::min_element(images, {}, &Image::height)->height;
  std::vector<Image> parts;
  int width = 0;
  for (const Image& image : images) {
    parts.push_back(image.height == height ? image : scaled_to_height(image, height));
    width += parts.back().width + (parts.size() > 1 ? gap : 0);
  }
  Image result(width, height, kWhite);
  int left = 0;
  for (const Image& part : parts) {
    paste(part, left, result);
    left += part.width + gap;
  }
  return result;
}

}  // namespace mimetra
