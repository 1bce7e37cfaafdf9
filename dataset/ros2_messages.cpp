#include "dataset/ros2_messages.h"

#include "dataset/set_files.h"

namespace uw {

namespace {

/// Appends values as CDR has them: each aligned to its own size, counted from the first of them.
class CdrWriter {
  public:
    CdrWriter() : bytes_("\0\1\0\0", 4) {}  // little-endian, no options

    template <class Number>
    CdrWriter& add(Number value) {
        bytes_.resize(bytes_.size() +
                      (sizeof(Number) - (bytes_.size() - 4) % sizeof(Number)) % sizeof(Number));
        append_bytes(bytes_, value);
        return *this;
    }
    CdrWriter& add_text(std::string_view text) {
        add(static_cast<std::uint32_t>(text.size() + 1));
        bytes_.append(text);
        bytes_.push_back('\0');
        return *this;
    }
    CdrWriter& add_vector(const Vector3& v) { return add(v.x).add(v.y).add(v.z); }
    CdrWriter& add_rotation(const Rotation& q) { return add(q.x).add(q.y).add(q.z).add(q.w); }
    CdrWriter& add_header(const RosHeader& header) {
        constexpr std::int64_t k_second = 1'000'000'000;
        add(static_cast<std::int32_t>(header.stamp / k_second));
        add(static_cast<std::uint32_t>(header.stamp % k_second));
        return add_text(header.frame);
    }
    CdrWriter& add_diagonal(const RosVariances& variances) {
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column) add(row == column ? variances[row] : 0.0);
        return *this;
    }
    CdrWriter& add_zeros(int count) {
        for (int i = 0; i < count; ++i) add(0.0);
        return *this;
    }
    CdrWriter& add_bytes(std::string_view bytes) {
        add(static_cast<std::uint32_t>(bytes.size()));
        bytes_.append(bytes);
        return *this;
    }

    std::string bytes() { return std::move(bytes_); }

  private:
    std::string bytes_;
};

struct RosDefinition {
    std::string_view name, text;
    std::vector<std::string_view> refers_to{};  // all that it consists of, in its words
};

/// What messages are made of, by the names that definitions use.
const std::vector<RosDefinition>& ros_parts() {
    static const std::vector<RosDefinition> k_parts{
        {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
        {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
        {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
        {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
        {"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
        {"geometry_msgs/Pose", "Point position\nQuaternion orientation\n"},
        {"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance\n"},
        {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular\n"},
        {"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance\n"},
        {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation\n"},
        {"geometry_msgs/TransformStamped",
         "std_msgs/Header header\nstring child_frame_id\nTransform transform\n"},
        {"sensor_msgs/RegionOfInterest",
         "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"}};
    return k_parts;
}

const RosDefinition& definition_of(RosType type) {
    static const std::array<RosDefinition, 9> k_types{
        {{"sensor_msgs/msg/Image",
          "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
          "uint8 is_bigendian\nuint32 step\nuint8[] data\n",
          {"std_msgs/Header", "builtin_interfaces/Time"}},
         {"sensor_msgs/msg/CameraInfo",
          "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
          "float64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\n"
          "uint32 binning_y\nRegionOfInterest roi\n",
          {"std_msgs/Header", "builtin_interfaces/Time", "sensor_msgs/RegionOfInterest"}},
         {"sensor_msgs/msg/Imu",
          "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
          "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
          "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
          "float64[9] linear_acceleration_covariance\n",
          {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/Quaternion",
           "geometry_msgs/Vector3"}},
         {"sensor_msgs/msg/FluidPressure",
          "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n",
          {"std_msgs/Header", "builtin_interfaces/Time"}},
         {"sensor_msgs/msg/MagneticField",
          "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\n"
          "float64[9] magnetic_field_covariance\n",
          {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/Vector3"}},
         {"geometry_msgs/msg/TwistWithCovarianceStamped",
          "std_msgs/Header header\nTwistWithCovariance twist\n",
          {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/TwistWithCovariance",
           "geometry_msgs/Twist", "geometry_msgs/Vector3"}},
         {"geometry_msgs/msg/PointStamped",
          "std_msgs/Header header\nPoint point\n",
          {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/Point"}},
         {"nav_msgs/msg/Odometry",
          "std_msgs/Header header\nstring child_frame_id\n"
          "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n",
          {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/PoseWithCovariance",
           "geometry_msgs/Pose", "geometry_msgs/Point", "geometry_msgs/Quaternion",
           "geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist", "geometry_msgs/Vector3"}},
         {"tf2_msgs/msg/TFMessage",
          "geometry_msgs/TransformStamped[] transforms\n",
          {"geometry_msgs/TransformStamped", "std_msgs/Header", "builtin_interfaces/Time",
           "geometry_msgs/Transform", "geometry_msgs/Vector3", "geometry_msgs/Quaternion"}}}};
    return k_types.at(static_cast<std::size_t>(type));
}

}  // namespace

std::string_view ros_name(RosType type) {
    return definition_of(type).name;
}

std::string ros_definition(RosType type) {
    const RosDefinition& definition = definition_of(type);
    std::string text(definition.text);
    for (const std::string_view part : definition.refers_to) {
        text += std::string(80, '=') + "\nMSG: " + std::string(part) + "\n";
        for (const RosDefinition& known : ros_parts())
            if (known.name == part) text += known.text;
    }
    return text;
}

std::string ros_imu(const RosHeader& header, const Vector3& rate, const RosVariances& of_rate,
                    const Vector3& force, const RosVariances& of_force) {
    // A first element of -1 says that there is no orientation.
    return CdrWriter()
        .add_header(header)
        .add_rotation({})
        .add(-1.0)
        .add_zeros(8)
        .add_vector(rate)
        .add_diagonal(of_rate)
        .add_vector(force)
        .add_diagonal(of_force)
        .bytes();
}

std::string ros_fluid_pressure(const RosHeader& header, double pressure, double variance) {
    return CdrWriter().add_header(header).add(pressure).add(variance).bytes();
}

std::string ros_magnetic_field(const RosHeader& header, const Vector3& field,
                               const RosVariances& variances) {
    return CdrWriter().add_header(header).add_vector(field).add_diagonal(variances).bytes();
}

std::string ros_twist(const RosHeader& header, const Vector3& velocity, const Matrix3& covariance) {
    CdrWriter cdr;
    cdr.add_header(header).add_vector(velocity).add_vector(Vector3(0.0));
    // A variance of -1 says that there is no angular velocity.
    for (int row = 0; row < 6; ++row)
        for (int column = 0; column < 6; ++column)
            cdr.add(row < 3 && column < 3 ? covariance[column][row] : row == column ? -1.0 : 0.0);
    return cdr.bytes();
}

std::string ros_point(const RosHeader& header, const Point3& point) {
    return CdrWriter().add_header(header).add(point.x).add(point.y).add(point.z).bytes();
}

std::string ros_odometry(const RosHeader& header, const std::string& child,
                         const BodyMotion& motion) {
    const Vector3 velocity = glm::transpose(motion.pose.rotation.matrix()) * motion.velocity;
    return CdrWriter()
        .add_header(header)
        .add_text(child)
        .add_vector(from_origin(motion.pose.position))
        .add_rotation(motion.pose.rotation)
        .add_zeros(36)
        .add_vector(velocity)
        .add_vector(motion.angular_velocity)
        .add_zeros(36)
        .bytes();
}

std::string ros_transforms(std::span<const RosTransform> transforms) {
    CdrWriter cdr;
    cdr.add(static_cast<std::uint32_t>(transforms.size()));
    for (const RosTransform& transform : transforms)
        cdr.add_header(transform.header)
            .add_text(transform.child)
            .add_vector(from_origin(transform.pose.position))
            .add_rotation(transform.pose.rotation);
    return cdr.bytes();
}

std::string ros_camera_info(const RosHeader& header, const CameraDesc& camera) {
    const DistortionDesc& d = camera.distortion;
    const bool is_rational = d.k[3] != 0 || d.k[4] != 0 || d.k[5] != 0;
    std::string_view model = is_rational ? "rational_polynomial" : "plumb_bob";
    std::vector<double> coefficients{d.k[0], d.k[1], d.p[0], d.p[1], d.k[2]};
    if (d.model == DistortionDesc::Model::fisheye) {
        model = "equidistant";
        coefficients = {d.k[0], d.k[1], d.k[2], d.k[3]};
    } else if (is_rational) {
        coefficients.insert(coefficients.end(), {d.k[3], d.k[4], d.k[5]});
    }
    const IntrinsicsDesc& i = camera.intrinsics;
    const double cx = i.cx - 0.5, cy = i.cy - 0.5;
    CdrWriter cdr;
    cdr.add_header(header)
        .add(static_cast<std::uint32_t>(camera.height))
        .add(static_cast<std::uint32_t>(camera.width))
        .add_text(model)
        .add(static_cast<std::uint32_t>(coefficients.size()));
    for (const double coefficient : coefficients) cdr.add(coefficient);
    for (const double number : {i.fx, 0.0, cx, 0.0, i.fy, cy, 0.0, 0.0, 1.0}) cdr.add(number);
    cdr.add_diagonal(Vector3(1.0));
    for (const double number : {i.fx, 0.0, cx, 0.0, 0.0, i.fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0})
        cdr.add(number);
    // No binning, and no region of interest.
    for (int number = 0; number < 6; ++number) cdr.add(std::uint32_t{0});
    return cdr.add(std::uint8_t{0}).bytes();
}

std::string ros_image(const RosHeader& header, int width, int height, std::string_view encoding,
                      std::string_view rows) {
    return CdrWriter()
        .add_header(header)
        .add(static_cast<std::uint32_t>(height))
        .add(static_cast<std::uint32_t>(width))
        .add_text(encoding)
        .add(std::uint8_t{0})
        .add(static_cast<std::uint32_t>(rows.size() / static_cast<std::size_t>(height)))
        .add_bytes(rows)
        .bytes();
}

}  // namespace uw
