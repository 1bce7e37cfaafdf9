#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/camera_desc.h"
#include "core/scene/trajectory.h"

namespace uw {

/// Messages of ROS 2 in its serialisation, CDR (OMG DDS-XTypes 1.3, section 7.4, version 1, little-
/// endian), by the definitions of Humble to Jazzy, which are the same for these.

/// The types that are written.
enum class RosType : std::uint8_t {
    image,           ///< sensor_msgs/msg/Image
    camera_info,     ///< sensor_msgs/msg/CameraInfo
    imu,             ///< sensor_msgs/msg/Imu
    fluid_pressure,  ///< sensor_msgs/msg/FluidPressure
    magnetic_field,  ///< sensor_msgs/msg/MagneticField
    twist,           ///< geometry_msgs/msg/TwistWithCovarianceStamped
    point,           ///< geometry_msgs/msg/PointStamped
    odometry,        ///< nav_msgs/msg/Odometry
    transforms       ///< tf2_msgs/msg/TFMessage
};

/// "sensor_msgs/msg/Imu".
std::string_view ros_name(RosType type);
/// Its definition and those that it refers to, as the encoding `ros2msg` of MCAP has them.
std::string ros_definition(RosType type);

/// When, and in whose axes.
struct RosHeader {
    std::int64_t stamp = 0;  // [ns], 0 <= stamp < 2^31 s
    std::string frame;
};

/// The pose of a frame in that of a header.
struct RosTransform {
    RosHeader header;
    std::string child;
    Pose pose;
};

/// The errors of three axes, independent of each other.
using RosVariances = Vector3;

std::string ros_imu(const RosHeader& header, const Vector3& rate, const RosVariances& of_rate,
                    const Vector3& force, const RosVariances& of_force);
std::string ros_fluid_pressure(const RosHeader& header, double pressure, double variance);
std::string ros_magnetic_field(const RosHeader& header, const Vector3& field,
                               const RosVariances& variances);
/// A linear velocity, with its covariance.
std::string ros_twist(const RosHeader& header, const Vector3& velocity, const Matrix3& covariance);
std::string ros_point(const RosHeader& header, const Point3& point);
/// A true motion: pose in the header's frame, velocities in the child's, without covariance.
std::string ros_odometry(const RosHeader& header, const std::string& child,
                         const BodyMotion& motion);
std::string ros_transforms(std::span<const RosTransform> transforms);
/// A camera without a port; the first pixel's centre is (0, 0).
std::string ros_camera_info(const RosHeader& header, const CameraDesc& camera);
/// `encoding`: "rgb8", of which `rows` has the bytes.
std::string ros_image(const RosHeader& header, int width, int height, std::string_view encoding,
                      std::string_view rows);

}  // namespace uw
