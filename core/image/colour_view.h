#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene/render_desc.h"

namespace uw {

/// What turns light into what a display shows, other than sRGB: a view of an OpenColorIO config.
class ColourView {
  public:
    ColourView() = default;
    virtual ~ColourView() = default;
    ColourView(const ColourView&) = delete;
    ColourView& operator=(const ColourView&) = delete;
    ColourView(ColourView&&) = delete;
    ColourView& operator=(ColourView&&) = delete;

    /// Turns linear sRGB, in which 1 is white before any tone curve, into the values that files
    /// store: R, G and B in turn, mostly 0 to 1. Threads may call it at once.
    virtual void apply(std::span<float> rgb) const = 0;

    std::uint64_t number = 0;                  // of this program's views, in the order made: from 1
    std::string name;                          // "Filmic / sRGB", with its look
    std::vector<std::filesystem::path> files;  // that it was made of, the config first
};

/// The view that a scene's pictures are seen through: that of its `render.view`, else that of the
/// config which the environment variable OCIO names; null: neither, so they are sRGB. The last one
/// is kept. Throws InputError, in one line that lists what there is, for a config, display, view or
/// look that does not exist; IoError for a file that cannot be read.
std::shared_ptr<const ColourView> colour_view(const std::optional<ViewDesc>& desc);

/// The OpenColorIO config that the environment variable OCIO names; empty: none.
std::filesystem::path config_of_environment();

/// The files that the config of a scene's view refers to as far as the view needs them; none, if
/// the view cannot be made. `desc` has a config.
std::vector<std::filesystem::path> files_named_by_view(const ViewDesc& desc);

/// What the module for OpenColorIO is asked for: words are empty where the config's defaults are
/// wanted.
struct ViewRequest {
    std::string config, display, view, look, input;
    /// Is told each file that the config refers to, before any is read. May throw.
    std::function<void(const std::filesystem::path&)> check;
};

/// What the module exports as k_make_view: makes `view`, or says in `fault` why there is none.
using MakeView = void(const ViewRequest& request, std::shared_ptr<ColourView>& view,
                      std::string& fault);
inline constexpr const char* k_make_view = "uwvdb_make_view_2";

}  // namespace uw
