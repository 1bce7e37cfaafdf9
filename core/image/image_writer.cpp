#include "core/image/image_writer.h"

#include "core/base/text.h"
#include "core/files/output_file.h"
#include "core/image/exr_file.h"
#include "core/image/png_writer.h"

namespace uw {

void write_exr(const std::filesystem::path& file, const Film& film, const ImageMetadata& metadata,
               const ExrOptions& options) {
    OutputFile out(file);
    write_exr(out, film, metadata, options);
    out.commit();
}

void write_exr(OutputFile& out, const Film& film, const ImageMetadata& metadata,
               const ExrOptions& options) {
    const ExrHeader header{film.width(),        film.height(),
                           film.window(),       exr_channels(film, options.precision),
                           options.compression, metadata};
    write_exr_file(out, film, header);
}

double as_stated_in_png(double value) {
    double rounded = value;
    parse_number(png_number(value), rounded);
    return rounded;
}

void write_png(const std::filesystem::path& file, const Preview& image,
               const ImageMetadata& metadata) {
    OutputFile out(file);
    write_png_file(out, image, metadata);
    out.commit();
}

void write_png(const std::filesystem::path& file, const Preview16& image,
               const ImageMetadata& metadata) {
    OutputFile out(file);
    write_png_file(out, image, metadata);
    out.commit();
}

void write_png(const std::filesystem::path& file, const DigitalImage& image,
               const ImageMetadata& metadata) {
    OutputFile out(file);
    write_png_file(out, image, metadata);
    out.commit();
}

}  // namespace uw
