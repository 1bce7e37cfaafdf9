#pragma once

namespace uw {

/// CIE 1931 tristimulus values, or values of the colour matching functions.
struct Xyz {
    double x = 0;
    double y = 0;
    double z = 0;
};

/// The colour matching functions of the CIE 1931 2 degree standard observer, dimensionless,
/// interpolated linearly in the 5 nm table; zero outside 360..830 nm.
/// Source: CIE 015 tables as in colour-science/colour, colour/colorimetry/datasets/cmfs.py (BSD-3).
Xyz cie1931_matching_functions(double wavelength_nm);

/// Their means over a wavelength interval, `begin_nm` < `end_nm`.
Xyz mean_matching_functions(double begin_nm, double end_nm);

}  // namespace uw
