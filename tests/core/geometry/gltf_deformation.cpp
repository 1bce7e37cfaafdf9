// ctest labels: unit analytic
#include "core/geometry/gltf_deformation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/base/error.h"
#include "core/geometry/gltf_reader.h"
#include "core/geometry/mesh_reader.h"
#include "tests/support/meshes/gltf_builder.h"
#include "tests/support/message_of.h"

namespace uw::test {
namespace {

// Files and their vertices have single precision; coordinates here are below 10.
constexpr double k_rounding = 2e-6;

MeshFile read_at(const std::filesystem::path& file, std::optional<double> time,
                 std::vector<std::string>* notes = nullptr) {
    std::vector<std::string> warnings;
    MeshFile mesh = read_mesh(file, warnings, {.diffuse_meant = true, .time = time});
    if (notes != nullptr)
        *notes = warnings;
    else
        EXPECT_TRUE(warnings.empty()) << warnings.front();
    return mesh;
}

Vector3 vector_at(const std::vector<float>& values, std::size_t index) {
    return {values.at(3 * index), values.at(3 * index + 1), values.at(3 * index + 2)};
}

void expect_near(const Vector3& found, const Vector3& expected, double tolerance = k_rounding) {
    EXPECT_LT(glm::length(found - expected), tolerance)
        << found.x << " " << found.y << " " << found.z << " for " << expected.x << " " << expected.y
        << " " << expected.z;
}

/// A ribbon along x from 0 to 2, one unit wide in z, on two joints: one at its beginning, and one
/// in its middle that turns about z by 90 degrees in the second from 1 to 2. A vertex at x follows
/// the second joint by x - 1/2, from 0 to 1. Their root is scaled by 2 and moved up by 3.
struct Ribbon {
    static constexpr int k_columns = 9;
    static double x_of(int column) { return 0.25 * column; }
    static double share_of(double x) { return std::clamp(x - 0.5, 0.0, 1.0); }
    static double angle_at(double time) {
        return std::numbers::pi / 2 * std::clamp(time - 1, 0.0, 1.0);
    }
    /// Where a point of the ribbon at rest, and its normal, are: the sum of the joints' matrices.
    static Vector3 point_at(double time, double x, double z) {
        const double a = angle_at(time), w = share_of(x);
        const Vector3 bent(1 + std::cos(a) * (x - 1), std::sin(a) * (x - 1), z);
        return 2.0 * ((1 - w) * Vector3(x, 0, z) + w * bent) + Vector3(0, 3, 0);
    }
    // (1 - w) 1 + w R(a) is a rotation about z by this angle and a scale.
    static Vector3 normal_at(double time, double x) {
        const double a = angle_at(time), w = share_of(x);
        const double turn = std::atan2(w * std::sin(a), 1 - w + w * std::cos(a));
        return {-std::sin(turn), std::cos(turn), 0};
    }

    std::vector<float> positions, normals, weights;
    std::vector<std::uint8_t> joints;
    std::vector<std::uint16_t> corners;
    std::string joint_list = "[2,3]", skin = R"("name":"spine")";
    std::vector<float> inverse_bind{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                    1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1};
    std::string scene_nodes = "[0,1]", more_attributes;

    Ribbon() {
        for (int column = 0; column < k_columns; ++column)
            for (const float z : {0.0F, 1.0F}) {
                const auto x = static_cast<float>(x_of(column));
                positions.insert(positions.end(), {x, 0, z});
                normals.insert(normals.end(), {0, 1, 0});
                const auto share = static_cast<float>(share_of(double{x}));
                weights.insert(weights.end(), {1 - share, share, 0, 0});
                joints.insert(joints.end(), {0, 1, 0, 0});
            }
        for (int column = 0; column + 1 < k_columns; ++column) {
            const auto first = static_cast<std::uint16_t>(2 * column);
            for (const int corner : {0, 1, 2, 2, 1, 3})
                corners.push_back(static_cast<std::uint16_t>(first + corner));
        }
    }

    std::string text() const {
        GltfBuilder builder;
        const float half = std::numbers::sqrt2_v<float> / 2;
        std::string attributes = "\"POSITION\":" + builder.add("VEC3", positions);
        attributes += ",\"NORMAL\":" + builder.add("VEC3", normals);
        attributes += ",\"JOINTS_0\":" + builder.add_bytes("VEC4", joints);
        attributes += ",\"WEIGHTS_0\":" + builder.add("VEC4", weights) + more_attributes;
        const std::string indices = builder.add_shorts("SCALAR", corners);
        const std::string times = builder.add_times({1, 2});
        const std::string turns = builder.add("VEC4", {0, 0, 0, 1, 0, 0, half, half});
        const std::string bind = builder.add("MAT4", inverse_bind);
        return builder.text(
            R"("scene":0,"scenes":[{"nodes":)" + scene_nodes +
            // The mesh's own transform does not count.
            R"(}],"nodes":[{"name":"ribbon","mesh":0,"skin":0,"translation":[100,50,0]},)"
            R"({"name":"root","translation":[0,3,0],"scale":[2,2,2],"children":[2]},)"
            R"({"name":"tail","children":[3]},{"name":"head","translation":[1,0,0]}],)"
            R"("meshes":[{"name":"ribbon","primitives":[{"attributes":{)" +
            attributes + R"(},"indices":)" + indices + R"(}]}],"skins":[{)" + skin +
            R"(,"joints":)" + joint_list + R"(,"inverseBindMatrices":)" + bind +
            R"(}],"animations":[{"channels":[{"sampler":0,"target":{"node":3,"path":"rotation"}}],)"
            R"("samplers":[{"input":)" +
            times + R"(,"output":)" + turns + "}]}]");
    }
};

class GltfSkin : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& text) const {
        return folder_.write("m.gltf", text);
    }
    void expect_refused(const std::string& text, const std::string& what) const {
        const std::string message = message_of<InputError>([&] { read_at(write(text), 1.5); });
        EXPECT_TRUE(message.starts_with(folder_.path("m.gltf").string() + ": ")) << message;
        EXPECT_NE(message.find(what), std::string::npos) << message;
    }
    MeshFolder folder_;
};

TEST_F(GltfSkin, BendsAsTheSumOfItsJoints) {
    const auto file = write(Ribbon().text());
    ASSERT_TRUE(gltf_keys(file));
    for (const double time : {0.0, 1.0, 1.3, 1.75, 2.0, 9.0}) {
        const MeshFile read = read_at(file, time);
        ASSERT_EQ(read.mesh.vertex_count(), 18U);
        EXPECT_EQ(read.mesh.triangle_count(), 16U);
        for (std::size_t vertex = 0; vertex < 18; ++vertex) {
            const double x = Ribbon::x_of(static_cast<int>(vertex / 2));
            const double z = static_cast<double>(vertex % 2);
            expect_near(vector_at(read.mesh.positions, vertex), Ribbon::point_at(time, x, z));
            expect_near(vector_at(read.mesh.normals, vertex), Ribbon::normal_at(time, x));
        }
    }
    // Without a time it has the pose of its nodes.
    std::vector<std::string> notes;
    expect_near(vector_at(read_at(file, {}, &notes).mesh.positions, 17), {4, 3, 2});
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("animations of 'head' stand still"), std::string::npos) << notes[0];
}

// What flow takes for where vertices are is what the image is made of, bit by bit.
TEST_F(GltfSkin, MomentsHaveTheVerticesOfTheMesh) {
    GltfSource source(write(Ribbon().text()), {});
    const GltfMoment moment = source.moment(1.4);
    std::vector<std::string> warnings;
    EXPECT_EQ(moment.vertices, source.read(1.4, warnings).mesh.positions);
    EXPECT_EQ(moment.deforms, std::vector<bool>{true});
    EXPECT_NE(moment.vertices, source.moment(1.6).vertices);
}

TEST_F(GltfSkin, WeightsMayBeBytesAndNeedNotSumToOne) {
    Ribbon ribbon;
    const std::vector<float> exact = read_at(write(ribbon.text()), 1.6).mesh.positions;
    // The sums of Blender's bytes are off by less than 1 %, and tripled weights are scaled.
    for (float& weight : ribbon.weights) weight *= 1.004F;
    const MeshFile close = read_at(write(ribbon.text()), 1.6);
    for (float& weight : ribbon.weights) weight *= 3;
    std::vector<std::string> notes;
    const MeshFile tripled = read_at(write(ribbon.text()), 1.6, &notes);
    for (std::size_t vertex = 0; vertex < 18; ++vertex) {
        expect_near(vector_at(close.mesh.positions, vertex), vector_at(exact, vertex));
        expect_near(vector_at(tripled.mesh.positions, vertex), vector_at(exact, vertex));
    }
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("the weights of 18 vertices of skins do not sum to 1"),
              std::string::npos)
        << notes[0];
    // A vertex without weights follows the joint that it names first.
    std::fill_n(ribbon.weights.begin() + 4 * 16, 4, 0.0F);
    std::fill_n(ribbon.joints.begin() + 4 * 16, 4, std::uint8_t{1});
    const MeshFile loose = read_at(write(ribbon.text()), 1.6, &notes);
    const double a = Ribbon::angle_at(1.6);
    expect_near(vector_at(loose.mesh.positions, 16),
                2.0 * Vector3(1 + std::cos(a), std::sin(a), 0) + Vector3(0, 3, 0));
    ASSERT_EQ(notes.size(), 2U);
    EXPECT_NE(notes[0].find("1 vertices of skins have no weight"), std::string::npos) << notes[0];
}

// Fifths of five joints in two sets, of which one turns.
TEST_F(GltfSkin, TakesAllSetsOfJoints) {
    GltfBuilder builder;
    const std::string positions = builder.add("VEC3", {1, 0, 0, 2, 0, 0, 1, 0, 1});
    const std::string first = builder.add_bytes("VEC4", {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3});
    const std::string second = builder.add_bytes("VEC4", {4, 9, 9, 9, 4, 9, 9, 9, 4, 9, 9, 9});
    const std::string normalized = ",\"normalized\":true";
    const std::string shares =
        builder.add_bytes("VEC4", std::vector<std::uint8_t>(12, 51), normalized);
    const std::string last =
        builder.add_bytes("VEC4", {51, 0, 0, 0, 51, 0, 0, 0, 51, 0, 0, 0}, normalized);
    const auto file = write(builder.text(
        R"("scenes":[{"nodes":[0,1,2,3,4,5]}],"nodes":[{"mesh":0,"skin":0},{},{},{},{},)"
        R"({"translation":[0,10,0],"scale":[6,1,1]}],"skins":[{"joints":[1,2,3,4,5]}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":)" +
        positions + R"(,"JOINTS_0":)" + first + R"(,"JOINTS_1":)" + second + R"(,"WEIGHTS_0":)" +
        shares + R"(,"WEIGHTS_1":)" + last + "}}]}]"));
    const MeshFile read = read_at(file, {});
    expect_near(vector_at(read.mesh.positions, 0), {2, 2, 0});
    expect_near(vector_at(read.mesh.positions, 1), {4, 2, 0});
    expect_near(vector_at(read.mesh.positions, 2), {2, 2, 1});
}

TEST_F(GltfSkin, RefusesWhatIsDamaged) {
    const auto changed = [](const std::function<void(Ribbon&)>& change) {
        Ribbon ribbon;
        change(ribbon);
        return ribbon.text();
    };
    expect_refused(changed([](Ribbon& r) { r.joints[4 * 17 + 1] = 7; }),
                   "mesh 'ribbon' follows joint 7 of skin 'spine', which has 2 joints");
    expect_refused(changed([](Ribbon& r) { r.weights[5] = NAN; }), "negative or not finite");
    expect_refused(changed([](Ribbon& r) { r.weights[5] = -0.5F; }), "negative or not finite");
    expect_refused(changed([](Ribbon& r) { r.joint_list = "[]"; }), "skin 'spine' has no joints");
    expect_refused(changed([](Ribbon& r) { r.joint_list = "[2,77]"; }),
                   "joint 1 of skin 'spine' is not a node of the file's scene");
    expect_refused(changed([](Ribbon& r) { r.joint_list = "[2,\"head\"]"; }), "is not a node");
    expect_refused(
        changed([](Ribbon& r) { r.scene_nodes = "[0]"; }),
        "joint 0 of skin 'spine' is not a node of the file's scene; export the armature");
    expect_refused(changed([](Ribbon& r) { r.inverse_bind.resize(16); }),
                   "skin 'spine' does not have an inverse bind matrix of floats for each of its 2");
    expect_refused(changed([](Ribbon& r) { r.inverse_bind[20] = INFINITY; }), "not finite");
    expect_refused(changed([](Ribbon& r) { r.weights.resize(4 * 17); }),
                   "glTF WEIGHTS_0 does not have the same count as POSITION");
    // Accessor 2 is of its joints, 3 of weights.
    expect_refused(changed([](Ribbon& r) { r.more_attributes = ",\"JOINTS_1\":2"; }),
                   "mesh 'ribbon' has JOINTS_1 without WEIGHTS_1");
    expect_refused(changed([](Ribbon& r) { r.more_attributes = ",\"JOINTS_1\":3"; }),
                   "glTF JOINTS_1 has an invalid component type");
    std::string missing = Ribbon().text();
    missing.replace(missing.find("\"skin\":0"), 8, "\"skin\":4");
    expect_refused(missing, "glTF 'skin' refers to an item that does not exist");
}

// Each digit of the description in turn becomes another one: indices, counts, sizes and types are
// forged one by one. Reading such a file ends with a mesh or with one line.
TEST_F(GltfSkin, ForgedNumbersEndInAMeshOrALine) {
    const std::string text = Ribbon().text();
    const std::size_t end = text.find("data:application");
    int read = 0, refused = 0;
    for (std::size_t at = 0; at < end; ++at) {
        if (std::isdigit(static_cast<unsigned char>(text[at])) == 0) continue;
        for (const char forged : {'0', '9'}) {
            std::string broken = text;
            broken[at] = forged;
            const auto file = write(broken);
            try {
                std::vector<std::string> notes;
                const MeshFile mesh = read_at(file, 1.5, &notes);
                EXPECT_EQ(mesh.mesh.positions.size() % 3, 0U);
                GltfSource(file, {}).moment(1.5);
                ++read;
            } catch (const InputError& error) {
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
                ++refused;
            }
        }
    }
    EXPECT_GT(read, 100);
    EXPECT_GT(refused, 100);
}

/// A square of corners (0,0) (1,0) (1,1) (0,1) with two morph targets, the first with normals.
struct Morph {
    std::string mesh_weights, node_weights, interpolation = "LINEAR", target = "weights";
    std::vector<float> keys{0, 1, 3}, values{0, 0, 1, 0.5F, 0, 2};
    std::vector<float> first{0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0};
    bool is_animated = true;

    std::string text(const std::string& more_nodes = "") const {
        GltfBuilder builder;
        const std::string positions = builder.add("VEC3", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
        const std::string normals = builder.add("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
        const std::string one = builder.add("VEC3", first);
        const std::string turn = builder.add("VEC3", {0, 0, 0, 0, 0, 0, 0.75F, 0, 0, 0, 0, 0});
        const std::string two = builder.add("VEC3", {1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0});
        const std::string indices = builder.add_shorts("SCALAR", {0, 1, 2, 0, 2, 3});
        const std::string times = builder.add_times(keys), weights = builder.add("SCALAR", values);
        return builder.text(
            R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[0,0,5])" +
            node_weights + "}" + more_nodes + R"(],"meshes":[{"name":"sheet")" + mesh_weights +
            R"(,"primitives":[{"attributes":{"POSITION":)" + positions + R"(,"NORMAL":)" + normals +
            R"(},"targets":[{"POSITION":)" + one + R"(,"NORMAL":)" + turn + R"(},{"POSITION":)" +
            two + R"(}],"indices":)" + indices + "}]}]" +
            (is_animated
                 ? R"(,"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":")" +
                       target + R"("}}],"samplers":[{"interpolation":")" + interpolation +
                       R"(","input":)" + times + R"(,"output":)" + weights + "}]}]"
                 : ""));
    }
};

class GltfMorph : public GltfSkin {
  protected:
    /// The weights that a file has at a time, read off where its vertices are.
    std::array<double, 2> weights_at(const Morph& morph, std::optional<double> time) const {
        std::vector<std::string> notes;  // that without a time its animation stands still
        const MeshFile read = read_at(write(morph.text()), time, &notes);
        EXPECT_EQ(notes.empty(), time.has_value() || !morph.is_animated);
        const std::vector<float>& p = read.mesh.positions;
        // The second target moves all along x, the first one corner along z.
        const std::array<double, 2> weights{(double{p.at(8)} - 5) / 2, double{p.at(0)}};
        expect_near(vector_at(p, 2), {1 + weights[1], 1, 5 + 2 * weights[0]});
        expect_near(vector_at(p, 3), {weights[1], 1, 5});
        const double across = 0.75 * weights[0];
        expect_near(vector_at(read.mesh.normals, 2), Vector3(across, 0, 1) / std::hypot(across, 1));
        expect_near(vector_at(read.mesh.normals, 1), {0, 0, 1});
        return weights;
    }
    static void expect_weights(const std::array<double, 2>& found, double one, double two) {
        EXPECT_NEAR(found[0], one, k_rounding);
        EXPECT_NEAR(found[1], two, k_rounding);
    }
};

TEST_F(GltfMorph, FollowsItsWeights) {
    Morph morph;
    expect_weights(weights_at(morph, -1), 0, 0);
    expect_weights(weights_at(morph, 0.25), 0.25, 0.125);
    expect_weights(weights_at(morph, 2), 0.5, 1.25);
    expect_weights(weights_at(morph, 7), 0, 2);
    morph.interpolation = "STEP";
    expect_weights(weights_at(morph, 0.99), 0, 0);
    expect_weights(weights_at(morph, 2.99), 1, 0.5);
    // t^3 - t and 2 t^2: of each key the slopes of both, their values, their slopes. A cubic
    // Hermite curve is exact.
    morph.interpolation = "CUBICSPLINE";
    morph.values.clear();
    for (const float t : morph.keys)
        for (const int part : {0, 1, 2})
            for (const float v : part == 1 ? std::array{t * t * t - t, 2 * t * t}
                                           : std::array{3 * t * t - 1, 4 * t})
                morph.values.push_back(v);
    for (const double t : {0.0, 0.5, 0.7, 1.0})
        expect_weights(weights_at(morph, t), t * t * t - t, 2 * t * t);
}

TEST_F(GltfMorph, TakesTheWeightsOfAnimationThenNodeThenMesh) {
    Morph morph;
    morph.mesh_weights = R"(,"weights":[0.5,0.25])";
    expect_weights(weights_at(morph, {}), 0.5, 0.25);
    morph.node_weights = R"(,"weights":[0.125,1])";
    expect_weights(weights_at(morph, {}), 0.125, 1);
    expect_weights(weights_at(morph, 1), 1, 0.5);
    morph.is_animated = false;
    expect_weights(weights_at(morph, {}), 0.125, 1);
}

// A mesh that several nodes show is kept once, unless it may deform.
TEST_F(GltfMorph, CostsNothingWhereItRests) {
    Morph morph;
    morph.is_animated = false;
    GltfSource still(write(morph.text()), {});
    EXPECT_TRUE(still.moment(0).vertices.empty());
    EXPECT_EQ(still.moment(0).deforms, std::vector<bool>{false});
    morph.is_animated = true;
    GltfSource moving(write(morph.text()), {});
    EXPECT_EQ(moving.moment(0).vertices.size(), 12U);
}

// The node listed first shows the same mesh, but nothing changes its weights.
TEST_F(GltfMorph, HasItsVerticesBeforeThoseOfRigidObjects) {
    std::string text = Morph().text(R"(,{"mesh":0,"name":"rigid"})");
    text.replace(text.find("[0]"), 3, "[1,0]");
    const auto file = write(text);
    const GltfMoment moment = GltfSource(file, {}).moment(1);
    EXPECT_EQ(moment.deforms, (std::vector<bool>{false, true}));
    const TriangleMesh mesh = read_at(file, 1).mesh;
    ASSERT_EQ(mesh.vertex_count(), 8U);
    ASSERT_EQ(moment.vertices.size(), 12U);
    EXPECT_TRUE(std::equal(moment.vertices.begin(), moment.vertices.end(), mesh.positions.begin()));
    EXPECT_EQ(mesh.triangle_objects, (std::vector<std::uint32_t>{1, 1, 0, 0}));
    expect_near(vector_at(mesh.positions, 6), {1, 1, 0});
}

TEST_F(GltfMorph, RefusesWhatIsDamaged) {
    const auto changed = [](const std::function<void(Morph&)>& change) {
        Morph morph;
        change(morph);
        return morph.text();
    };
    expect_refused(changed([](Morph& m) { m.values.pop_back(); }), "not as many values as times");
    expect_refused(changed([](Morph& m) { m.values[1] = NAN; }), "not finite");
    expect_refused(changed([](Morph& m) { m.first.resize(9); }),
                   "glTF POSITION does not have the same count as POSITION");
    expect_refused(changed([](Morph& m) {
                       m.is_animated = false;
                       m.node_weights = R"(,"weights":[1])";
                   }),
                   "node 'node0' has 1 weights for the 2 morph targets of its mesh");
    expect_refused(changed([](Morph& m) {
                       m.is_animated = false;
                       m.mesh_weights = R"(,"weights":["a",1])";
                   }),
                   "the glTF description is broken");
    // A corner that is nowhere takes its triangles with it, as one of a mesh that stands does.
    std::vector<std::string> notes;
    const MeshFile read = read_at(write(changed([](Morph& m) { m.first[10] = NAN; })), 1.0, &notes);
    EXPECT_EQ(read.mesh.triangle_count(), 1U);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("1 triangles have corners that are NaN"), std::string::npos);
}

}  // namespace
}  // namespace uw::test
