#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image/exr_header.h"
#include "core/image/film.h"

namespace uw {

/// The blocks of lines of which the pixels of an EXR consist.
class ExrBlocks {
  public:
    /// Of the film's window, with the channels and the compression of `header`, each of whose
    /// channels the film has. Both outlive this.
    ExrBlocks(const Film& film, const ExrHeader& header);

    std::size_t count() const;
    /// One block as it stands in the file, from the top of the image: its first line, its size, its
    /// values. May be called from several threads.
    std::vector<std::byte> encoded(std::size_t block) const;

  private:
    struct Source {
        std::size_t channel;  // of the film
        bool is_half;
    };
    std::vector<std::byte> values(int begin, int end) const;

    const Film& film_;
    ExrCompression compression_;
    std::vector<Source> sources_;  // in the file's order
    std::size_t bytes_per_pixel_ = 0;
};

}  // namespace uw
