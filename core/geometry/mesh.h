#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/spectrum.h"
#include "core/base/vector_math.h"

namespace uw {

/// Linear red, green, blue of a diffuse reflectance, 0..1 (sRGB primaries, as in files).
using Rgb = std::array<double, 3>;

/// IEC 61966-2-1: the sRGB code value in 0..1 as linear light.
inline double linear_from_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Converts the RGB reflectance of mesh files into one value per wavelength band.
///
/// Three bands are red, green and blue in this order, whatever their wavelengths. Any other number
/// of bands is interpolated linearly in wavelength between blue at 450 nm, green at 540 nm and red
/// at 620 nm, and held constant beyond these ends: RGB contains no more information.
class ReflectanceBands {
  public:
    /// `wavelengths_nm`: one per band, at most k_max_bands (else std::invalid_argument).
    explicit ReflectanceBands(const std::vector<double>& wavelengths_nm);

    int count() const { return static_cast<int>(weights_.size()); }
    /// Reflectance per band; entries past the band count are zero.
    Spectrum from_rgb(const Rgb& rgb) const;

  private:
    std::vector<Rgb> weights_;  // per band: the weights of R, G, B; they sum to 1
};

struct PixelImage;
class PartialImage;

enum class TextureFilter { nearest, linear };
enum class TextureWrap { repeat, clamp, mirror };

/// How a material samples a texture.
struct TextureLookup {
    TextureFilter filter = TextureFilter::linear;
    TextureWrap wrap_u = TextureWrap::repeat;
    TextureWrap wrap_v = TextureWrap::repeat;
};

/// How an image encodes its values.
enum class TextureEncoding { srgb, linear };

/// The parallelogram that a look-up averages over: its sides as (u, v), and around the point. Zero:
/// the point alone.
struct TextureSpread {
    std::array<double, 2> across{}, down{};
};

/// A linear RGB image; immutable, shared by materials, thread safe. Beside it are images of half
/// its size, of a quarter, and so on, each the mean of the one before, for look-ups over many
/// texels.
class Texture {
  public:
    /// Decodes sRGB code values of colours (glTF 2.0, 3.9.2); `linear` values, as in normal maps,
    /// and those of linear images are used as they are. Grey images fill all three channels; alpha,
    /// which is always linear, is dropped unless `keep_alpha`. Throws std::invalid_argument for an
    /// image without pixels.
    explicit Texture(const PixelImage& image, TextureEncoding encoding = TextureEncoding::srgb,
                     bool keep_alpha = false);

    /// The same of an image that is read in parts: what is in memory are images of at most
    /// `most_texels`, made of all of it here; finer ones are looked up in the file. Throws
    /// InputError if it cannot be read; messages call it `name`.
    Texture(std::shared_ptr<const PartialImage> image, const std::string& name,
            TextureEncoding encoding, bool keep_alpha,
            std::int64_t most_texels = std::int64_t{1} << 23);

    int width() const { return levels_.front().width; }
    int height() const { return levels_.front().height; }

    /// Linear RGB at (u, v): (0, 0) is the outer corner of the top left texel, (1, 1) that of the
    /// bottom right one (glTF 2.0, 3.6.2). `linear` interpolates between texel centres in linear
    /// light.
    Rgb sample(double u, double v, const TextureLookup& lookup) const;
    /// The mean over a parallelogram, by up to 16 look-ups along its longer side in the images
    /// whose texels are about as wide as its shorter one (or a 16th of the longer). Within a texel
    /// it is the look-up at the point.
    Rgb sample(double u, double v, const TextureLookup& lookup, const TextureSpread& spread) const;
    /// The same for alpha, if kept; else 1.
    double sample_alpha(double u, double v, const TextureLookup& lookup) const;

  private:
    struct Level {
        int width = 0, height = 0;
        /// How many of its texels the texture covers: all, but for the ends of the last row and
        /// column where those of a file were put together by twos.
        double columns = 0, rows = 0;
        std::vector<float> rgb;  // row-major, top row first; empty: in the file
        int halvings = 0;        // of those in the file
    };
    /// The texels around a point and their weights; for `nearest`, one.
    struct Footprint {
        std::array<std::size_t, 4> texels{};
        std::array<double, 4> weights{};
        std::size_t count = 0;
    };
    static Footprint footprint(const Level& level, double u, double v, const TextureLookup& lookup);
    Rgb sample(const Level& level, double u, double v, const TextureLookup& lookup) const;
    double decoded(float encoded) const;
    /// Texels of a level that is in the file, `columns` times `rows` from (x, y) on: means over the
    /// pixels that they stand for.
    void texels_of_file(const Level& level, int x, int y, int columns, int rows,
                        std::span<Rgb> texels) const;
    double alpha_of_file(std::size_t place) const;
    void sum_lines(Level& level) const;
    [[noreturn]] void fail_to_read() const;
    /// Half as wide and high, rounded up.
    static Level halved(const Level& level);

    std::vector<Level> levels_;  // the image itself, and then always halves, to a single texel
    std::vector<float> alpha_;   // of the image; empty: 1 everywhere, or in the file
    std::shared_ptr<const PartialImage> file_;  // null: all is in memory
    std::string name_;                          // of that file, for messages
    bool is_encoded_ = false, has_alpha_in_file_ = false;
};

/// The texture in a file, read as a whole or in parts. Throws as read_image and open_partial_image.
std::shared_ptr<const Texture> read_texture(const std::filesystem::path& file,
                                            TextureEncoding encoding = TextureEncoding::srgb,
                                            bool keep_alpha = false);

/// A texture as one material uses it.
struct TextureUse {
    std::shared_ptr<const Texture> texture;  // null: none
    TextureLookup lookup;
    std::size_t uv_set = 0;  // 0 or 1
    /// KHR_texture_transform: u' = a[0] u + a[1] v + a[2], v' = a[3] u + a[4] v + a[5].
    std::array<double, 6> transform{1, 0, 0, 0, 1, 0};

    explicit operator bool() const { return texture != nullptr; }
    Rgb sample(double u, double v) const {
        return texture->sample(moved_u(u, v), moved_v(u, v), lookup);
    }
    /// Over a parallelogram that is given before the transform.
    Rgb sample(double u, double v, const TextureSpread& spread) const {
        return texture->sample(moved_u(u, v), moved_v(u, v), lookup,
                               {turned(spread.across), turned(spread.down)});
    }
    double sample_alpha(double u, double v) const {
        return texture->sample_alpha(moved_u(u, v), moved_v(u, v), lookup);
    }

  private:
    double moved_u(double u, double v) const {
        return transform[0] * u + transform[1] * v + transform[2];
    }
    double moved_v(double u, double v) const {
        return transform[3] * u + transform[4] * v + transform[5];
    }
    std::array<double, 2> turned(const std::array<double, 2>& d) const {
        return {transform[0] * d[0] + transform[1] * d[1],
                transform[3] * d[0] + transform[4] * d[1]};
    }
};

/// A surface's material as given by a mesh file. Colours are linear; factors multiply their maps.
struct MeshMaterial {
    Rgb base_color{0.5, 0.5, 0.5};  // 0..1; also multiplied by vertex colours
    TextureUse base_map;
    bool double_sided = true;  // as in the file; surfaces are opaque from both sides
    /// There is a hole where alpha (times that of base map and vertices) is below the cutoff; 0:
    /// nowhere.
    double alpha = 1, alpha_cutoff = 0;
    Rgb emission{0, 0, 0};  // radiance [W m^-2 sr^-1], on both sides
    TextureUse emission_map;
    TextureUse normal_map;    // linear; x, y, z of the tangent frame as 0..1 for -1..1
    double normal_scale = 1;  // of its x and y
    // Metallic-roughness (glTF 2.0, appendix B); read for GltfUse::pbr only.
    double metallic = 0, roughness = 1;  // 0..1
    TextureUse metallic_roughness_map;   // linear; green roughness, blue metallic
    double ior = 1.5;                    // of the dielectric; 0: reflects everything
    std::uint32_t number = 0;            // in MeshFile::materials, from 1; 0: none of the file's
};

/// Triangles with what their corners and faces carry. Inert.
struct TriangleMesh {
    std::vector<float> positions;          // x, y, z per vertex
    std::vector<std::uint32_t> triangles;  // three vertices each; all in range
    // Per vertex; empty if the file has none at all. A zero normal means "flat".
    std::vector<float> normals;             // x, y, z, unit
    std::array<std::vector<float>, 2> uvs;  // u, v; origin at the texture's top left, v down
    std::vector<float> colors;              // linear r, g, b, 0..1
    std::vector<float> alphas;              // 0..1
    /// x, y, z of the unit direction in which the normal map's u increases, and the sign of
    /// cross(normal, tangent) relative to the direction in which its v decreases; all zero if there
    /// is none.
    std::vector<float> tangents;
    std::vector<std::uint32_t> triangle_materials;  // per triangle; empty: all have material 0
    std::vector<MeshMaterial> materials{MeshMaterial{}};  // at least one
    std::vector<std::uint32_t>
        triangle_objects;  // per triangle, in MeshFile::objects; empty: all 0

    std::size_t vertex_count() const { return positions.size() / 3; }
    std::size_t triangle_count() const { return triangles.size() / 3; }
};

/// A mesh that several objects of a file show.
struct SharedMesh {
    struct Placement {
        Affine file_from_mesh;  // invertible
        std::uint32_t object = 0;
    };
    TriangleMesh mesh;  // in its own space; has no triangle_objects
    std::vector<Placement> placements;
};

/// What a mesh file shows, in the file's own space [m]. Inert.
struct MeshFile {
    TriangleMesh mesh;               // all that is there once, node hierarchy applied
    std::vector<SharedMesh> shared;  // the rest; none without triangles
    /// The names of what the file counts as an object, in its order: glTF nodes that show a mesh,
    /// OBJ's objects and groups, the whole of other files. Not unique.
    std::vector<std::string> objects;
    std::vector<std::string> materials;  // likewise, of all materials in the file

    bool has_triangles() const { return !mesh.triangles.empty() || !shared.empty(); }
};

/// What the scene takes from a glTF file besides triangles and diffuse materials.
struct GltfUse {
    /// Its camera or lamps, which import_gltf reads: the file need not show a mesh.
    bool camera_or_lamps = false;
    bool pbr = false;              // metallic, roughness and refractive index
    bool diffuse_meant = false;    // metal is shown as diffuse on request, and not reported
    std::optional<double> time{};  // of its animations [s]; none: its nodes are as they are written
};

/// Computes the tangents that a mesh with normal maps lacks (all zero) from the texture coordinates
/// of each triangle's normal map: at every vertex the mean over its triangles, weighted by their
/// angles and projected into the plane perpendicular to the normal, as MikkTSpace does, except that
/// vertices shared by mirrored halves of a texture take the side of the majority. Triangles without
/// vertex normals or with invalid coordinates keep zeros. Precondition: corners are in range.
void compute_tangents(TriangleMesh& mesh);

/// The directions in which the u of a triangle's normal map increases and its v decreases [any
/// length]; false if the coordinates are degenerate. `use` is the map.
struct UvAxes {
    Vector3 u_axis{0.0}, up_axis{0.0};
};
bool uv_axes(const TriangleMesh& mesh, const std::uint32_t* corners, const TextureUse& use,
             UvAxes& axes);

}  // namespace uw
