#pragma once

#include <array>
#include <string>

namespace uw::test {

/// A camera 'Eye' and a spot 'Torch' on an animated, turning vehicle, and a mesh 'Crate' that
/// moves, turns and grows, at 24 frames per second: frames 0 to 12 as Blender 3.4.1 exports them.
/// Its nodes are written as they are in frame 5.
inline std::string vehicle_gltf() {
    return R"({"asset":{"generator":"Khronos glTF Blender I/O v3.4.50","version":"2.0"},"extensionsUse)"
           R"(d":["KHR_lights_punctual"],"extensionsRequired":["KHR_lights_punctual"],"extensions":{"K)"
           R"(HR_lights_punctual":{"lights":[{"color":[1,1,1],"intensity":543.5141306588226,"spot":{"i)"
           R"(nnerConeAngle":0.3337942263919169,"outerConeAngle":0.39269909262657166},"type":"spot","n)"
           R"(ame":"Torch"}]}},"scene":0,"scenes":[{"name":"Scene","nodes":[2,3]}],"nodes":[{"camera":)"
           R"(0,"name":"Eye","rotation":[-0.08682409673929214,0.08682409673929214,0.007596124429255724)"
           R"(,0.9924038648605347],"translation":[0.10000000149011612,0.2999999523162842,0.20000000298)"
           R"(023224]},{"extensions":{"KHR_lights_punctual":{"light":0}},"name":"Torch","translation":)"
           R"([-0.20000000298023224,0.10000002384185791,0]},{"children":[0,1],"name":"Vehicle","transl)"
           R"(ation":[0,1,0]},{"mesh":0,"name":"Crate","translation":[1,0,-3]}],"cameras":[{"name":"Ey)"
           R"(e","perspective":{"aspectRatio":1.7777777777777777,"yfov":0.4710899591445923,"zfar":1000)"
           R"(,"znear":0.10000000149011612},"type":"perspective"}],"animations":[{"channels":[{"sample)"
           R"(r":0,"target":{"node":2,"path":"translation"}},{"sampler":1,"target":{"node":2,"path":"r)"
           R"(otation"}}],"name":"VehicleAction","samplers":[{"input":2,"interpolation":"LINEAR","outp)"
           R"(ut":3},{"input":2,"interpolation":"LINEAR","output":4}]},{"channels":[{"sampler":0,"targ)"
           R"(et":{"node":3,"path":"translation"}},{"sampler":1,"target":{"node":3,"path":"rotation"}})"
           R"(,{"sampler":2,"target":{"node":3,"path":"scale"}}],"name":"CrateAction","samplers":[{"in)"
           R"(put":2,"interpolation":"LINEAR","output":5},{"input":2,"interpolation":"LINEAR","output")"
           R"(:6},{"input":2,"interpolation":"LINEAR","output":7}]}],"meshes":[{"name":"Crate","primit)"
           R"(ives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[{"bufferView":0,"compon)"
           R"(entType":5126,"count":4,"max":[0.10000000149011612,0.10000000149011612,0.100000001490116)"
           R"(12],"min":[-0.10000000149011612,-0.10000000149011612,-0.10000000149011612],"type":"VEC3")"
           R"(},{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"},{"bufferView":2,"comp)"
           R"(onentType":5126,"count":13,"max":[0.5],"min":[0],"type":"SCALAR"},{"bufferView":3,"compo)"
           R"(nentType":5126,"count":13,"type":"VEC3"},{"bufferView":4,"componentType":5126,"count":13)"
           R"(,"type":"VEC4"},{"bufferView":5,"componentType":5126,"count":13,"type":"VEC3"},{"bufferV)"
           R"(iew":6,"componentType":5126,"count":13,"type":"VEC4"},{"bufferView":7,"componentType":51)"
           R"(26,"count":13,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":48,"byteOffset":0,)"
           R"("target":34962},{"buffer":0,"byteLength":24,"byteOffset":48,"target":34963},{"buffer":0,)"
           R"("byteLength":52,"byteOffset":72},{"buffer":0,"byteLength":156,"byteOffset":124},{"buffer)"
           R"(":0,"byteLength":208,"byteOffset":280},{"buffer":0,"byteLength":156,"byteOffset":488},{")"
           R"(buffer":0,"byteLength":208,"byteOffset":644},{"buffer":0,"byteLength":156,"byteOffset":8)"
           R"(52}],"buffers":[{"byteLength":1008,"uri":"data:application/octet-stream;base64,zczMvc3Mz)"
           R"(L3NzMw9zczMPc3MzL3NzMw9AAAAAM3MzL3NzMy9AAAAAM3MzD0AAACAAAACAAEAAAABAAMAAQACAAMAAgAAAAMAA)"
           R"(AAAAKuqKj2rqqo9AAAAPquqKj5VVVU+AACAPlVVlT6rqqo+AADAPlVV1T6rquo+AAAAPwAAAAAAAIA/AAAAgGovI)"
           R"(T105YE/J7QXuye0Fz4Vo4Y/J7SXvAAAoD7OzIw/AACAvaK9BD+F9pI/J7QXvrSXQD8mtJc/7CWUvgAAgD+amZk/A)"
           R"(AAAvya0nz8mtJc/j+NIvy+hvT+F9pI/5DiOvwAA2D/MzIw/AAC4v3sJ7T8Vo4Y/yHHcv4X2+j905YE/4zj2vwAAA)"
           R"(EAAAIA/AAAAwAAAAAAAAAAAAAAAgAAAgD+U0IA6Xd+APL1C87sO9n8/LChKO1QCcj1UO9a8v3Z/P3z7ljuF4/09A)"
           R"(q9QvfyvfT+8FZg7wLtQPkfanL2m2nk/7i+LO3KFlT7M28i9HIxzP8WS5DsFycM+lb7jvV7Raj8K95w8PavwPhzw4)"
           R"(73/GGA/BnEuPfHmDD9z3tC9mNpTPzkjlj3iUB4/k1K5vZH0Rj+CvdY9GoMrP9rNpb1dADs/z6AEPmvLMz/AW5m9b)"
           R"(ioyP/nHDj6trzY/e8KUvR7DLj8AAIA/AAAAAAAAQMBeQoE/ai8hPDChQMChvYQ/J7QXPdFeQsAAAIo/AACgPQAAR)"
           R"(cC1l5A/or0EPtpLSMD2Epg/tJdAPnwJTMAAAKA/AACAPgAAUMAJ7ac/JbSfPoT2U8BMaK8/MaG9Pia0V8AAALY/A)"
           R"(ADYPgAAW8BeQrs/fAntPi+hXcCivb4/hvb6PtJeX8AAAMA/AAAAPwAAYMAAAAAAAAAAAAAAAIAAAIA/AAAAAAAAA)"
           R"(ADDLKG8UfN/PwAAAAAAAAAAqZCXvUlMfz8AAAAAAAAAAIpZH76g4Xw/AAAAAAAAAABAQoO+zXF3PwAAAAAAAAAAN)"
           R"(hW8vu4Zbj8AAAAAAAAAAEN39b5AqWA/AAAAAAAAAABkixW/ocdPPwAAAAAAAAAA+sEsv4brPD8AAAAAAAAAAJ9EP)"
           R"(7+LJyo/AAAAAAAAAADplky/WuEZPwAAAAAAAAAAT6dUv2OHDj8AAAAAAAAAAKRqV79BUQo/AACAPwAAgD8AAIA/X)"
           R"(kKBP15CgT9eQoE/ob2EP6G9hD+hvYQ/AACKPwAAij8AAIo/tZeQP7WXkD+1l5A/9hKYP/YSmD/2Epg///+fP///n)"
           R"(z8AAKA/Cu2nPwrtpz8J7ac/TGivP0xorz9MaK8/AAC2PwAAtj8AALY/XkK7P15Cuz9eQrs/o72+P6O9vj+ivb4//)"
           R"(/+/P///vz8AAMA/"}]})";
}

/// Where Blender itself has them in a frame, in the axes of the file (y up).
struct VehicleFrame {
    int frame;
    /// Rows of file_from_object; camera and light look along -z with y up.
    std::array<std::array<double, 4>, 3> eye, torch;
    std::array<std::array<double, 3>, 4> crate;  // its corners
};

inline constexpr std::array<VehicleFrame, 4> k_vehicle_frames{{
    {0,
     {{{0.98480773, -0.0301536955, 0.171010062, 0.100000001},
       {0, 0.98480773, 0.173648223, 1.29999995},
       {-0.173648179, -0.171010107, 0.969846308, 0.200000003}}},
     {{{1, 0, 0, -0.200000003}, {0, 1, -4.37113883e-08, 1.10000002}, {0, 4.37113883e-08, 1, 0}}},
     {{{0.9, -0.1, -2.9}, {1.1, -0.1, -2.9}, {1, -0.1, -3.1}, {1, 0.1, -3}}}},
    {4,
     {{{0.82244426, 0.0538746193, 0.566288769, 0.733889341},
       {-0.138369247, 0.984551728, 0.107292697, 1.42179847},
       {-0.551760256, -0.166599199, 0.817193568, -0.0112870634}}},
     {{{0.90516603, 0.151391193, 0.397184014, 0.352624476},
       {-0.14760685, 0.9882254, -0.0402833745, 1.27649212},
       {-0.398605883, -0.0221639406, 0.916854441, -0.0706433877}}},
     {{{0.975531489, 0.087498939, -3.01666664},
       {1.17176043, -0.0244686007, -3.01666664},
       {1.07364596, 0.0315151691, -3.24259259},
       {1.1856135, 0.227744114, -3.12962961}}}},
    {7,
     {{{0.383052707, 0.0535492152, 0.922173023, 1.52861643},
       {-0.150161743, 0.988648951, 0.004964903, 1.43221259},
       {-0.911439538, -0.140376925, 0.386745781, -0.77729851}}},
     {{{0.533319473, 0.212869406, 0.818692207, 1.16230822},
       {-0.176842824, 0.974491298, -0.138178512, 1.31800294},
       {-0.827222466, -0.0710865557, 0.557359636, -0.626386404}}},
     {{{1.14586212, 0.394668576, -3.180729},
       {1.22917393, 0.145862147, -3.180729},
       {1.18751802, 0.270265362, -3.44311324},
       {1.43632445, 0.353577176, -3.31192112}}}},
    {12,
     {{{-0.194284379, 0.131369933, 0.972108781, 2.27736187},
       {0.149376899, 0.983396649, -0.103041083, 1.23634374},
       {-0.969505072, 0.125191316, -0.210682243, -2.08492374}}},
     {{{-0.0290536694, 0.29817912, 0.954067647, 2.03562856},
       {0.0998334214, 0.950563788, -0.294043869, 1.07508969},
       {-0.994579911, 0.0867047831, -0.0573856086, -1.79241359}}},
     {{{1.42602742, 0.698816633, -3.35},
       {1.30118337, 0.426027417, -3.35},
       {1.36360539, 0.562422025, -3.65},
       {1.63639461, 0.437577975, -3.5}}}},
}};

}  // namespace uw::test
