#pragma once

#include "dataset/formats/format.h"

/// One format per file. Private to this folder.
namespace uw {

DatasetFormat png_format();
DatasetFormat depth_format();
DatasetFormat mask_format();
DatasetFormat ids_format();
DatasetFormat clean_format();
DatasetFormat exr_format();
DatasetFormat numpy_format();
DatasetFormat flow_format();
DatasetFormat disparity_format();
DatasetFormat kitti_format();
DatasetFormat colmap_format();
DatasetFormat nerfstudio_format();
DatasetFormat tum_format();
DatasetFormat euroc_format();
DatasetFormat calibration_format();

}  // namespace uw
