#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace uw {

/// A luminaire's type C photometry as stored in an IES file (LM-63 of 1986, 1991, 1995, 2002 and
/// later): the vertical angle is measured from the luminaire's main axis, the horizontal angle
/// around it.
struct IesFile {
    int year = 1986;             // of the standard named in the first line
    double lumens = 0;           // of all lamps; negative: not given (absolute photometry)
    std::vector<double> polar;   // vertical angles [deg], strictly ascending within 0..180
    std::vector<double> planes;  // horizontal angles [deg], strictly ascending within 0..360
    /// Candelas with every factor of the file applied, plane by plane: [plane][polar].
    std::vector<double> candelas;
    std::vector<std::string> warnings;  // one line each
};

/// Parses the text of an IES file; messages refer to it as `name`. Throws a one-line InputError
/// that states the file, the line, what is wrong (photometry of type A or B, counts that do not
/// match the data, angles that do not ascend, ...) and how to fix it.
IesFile parse_ies(std::string_view text, const std::string& name);

/// The same for a file of at most 4 MiB. Throws IoError if it cannot be read.
IesFile read_ies(const std::filesystem::path& file);

/// The luminous intensity of a luminaire in every direction, of an IES file's kind: interpolated
/// linearly in both angles, symmetries unfolded to the full circle, 0 outside the file's vertical
/// angles. Polar angles are measured from the luminaire's axis (0..pi), azimuths around it (0..2
/// pi) [rad].
class PhotometricWeb {
  public:
    /// `file` as parse_ies returns it.
    explicit PhotometricWeb(const IesFile& file);

    /// Luminous intensity [cd]. `azimuth` within -pi..2 pi.
    double candelas(double polar, double azimuth) const;
    /// Luminous intensity in the brightest direction [cd].
    double peak() const { return peak_; }
    /// Luminous flux: the intensity integrated over the sphere [lm].
    double flux() const;
    /// Whether the intensity is the same all around the axis.
    bool is_rotational() const { return azimuth_.empty(); }

    /// The polar angle beyond which the luminaire is dark; pi if there is none.
    double dark_angle() const { return dark_angle_; }
    /// Polar angles and azimuths at which a quadrature should be split: where the intensity jumps
    /// or becomes 0, and as many of the file's angles as a piecewise parabola needs to follow it to
    /// 1e-3. Ascending.
    std::span<const double> polar_breaks() const { return polar_breaks_; }
    std::span<const double> azimuth_breaks() const { return azimuth_breaks_; }

  private:
    double value(std::size_t plane, std::size_t i) const {
        return candelas_[plane * polar_.size() + i];
    }
    void unfold(const IesFile& file);
    void find_breaks();

    std::vector<double> polar_;
    std::vector<double>
        azimuth_;  // from 0 to 2 pi, the last plane repeats the first; empty: one plane
    std::vector<double> candelas_;  // [plane][polar]
    std::vector<double> polar_breaks_, azimuth_breaks_;
    double peak_ = 0;
    double dark_angle_ = 0;
};

}  // namespace uw
