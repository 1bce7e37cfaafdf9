#pragma once

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>

#include <cstdint>
#include <string_view>

#include "core/base/output_files.h"

namespace uw {

struct ExrHeader;

/// OpenEXR's way to an OutputFile, which keeps errors until it is committed.
class ExrStream : public Imf::OStream {
  public:
    explicit ExrStream(OutputFile& out) : OStream("image"), out_(out) {}
    void write(const char bytes[], int count) override {
        out_.write(std::string_view(bytes, static_cast<std::size_t>(count)));
    }
    std::uint64_t tellp() override { return out_.position(); }
    void seekp(std::uint64_t position) override { out_.seek(position); }

  private:
    OutputFile& out_;
};

/// OpenEXR's header of an image, with its windows, channels and metadata.
Imf::Header openexr_header(const ExrHeader& header);

/// Has OpenEXR work on all permitted threads.
void permit_exr_threads();

}  // namespace uw
