#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace uw {

/// How far a run of several images has got, and how long it will take.
class SequenceClock {
  public:
    /// `noun`: what messages call one of them.
    explicit SequenceClock(std::size_t images, std::string noun = "frame")
        : images_(images), noun_(std::move(noun)) {}

    void finish_image() { ++done_; }
    std::size_t images_done() const { return done_; }
    bool finished() const { return done_ == images_; }
    bool is_sequence() const { return images_ > 1; }

    /// "frame 3 of 10: render"; of a single image "render".
    std::string label(const std::string& pass) const {
        if (!is_sequence()) return pass;
        return noun_ + " " + std::to_string(done_ + 1) + " of " + std::to_string(images_) + ": " +
               pass;
    }

    /// From now until all images are done, if they take as long as those before [s]; empty until
    /// the first is done.
    std::optional<double> seconds_left() const {
        if (!is_sequence() || done_ == 0) return std::nullopt;
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
        return elapsed.count() * static_cast<double>(images_ - done_) / static_cast<double>(done_);
    }

  private:
    std::size_t images_;
    std::string noun_;
    std::size_t done_ = 0;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace uw
