// The programs that turn planes of linear light into a picture.

import { RAMP } from "./false_colour.js";

export const VERTEX = `#version 300 es
out vec2 place;
void main() {
    // One triangle that covers the view; the image's first row is its upper.
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    place = vec2(0.5 + 0.5 * corner.x, 0.5 - 0.5 * corner.y);
    gl_Position = vec4(corner, 0.0, 1.0);
}`;

export const FRAGMENT = `#version 300 es
precision highp float;
precision highp sampler2DArray;
uniform sampler2DArray planes;
uniform sampler2D mix_table;  // per entry: the plane's index, and its weight per channel
uniform int mix_count;
uniform float exposure;
uniform bool false_colour;
uniform vec3 ramp[${RAMP.length}];
in vec2 place;
out vec4 colour;

vec3 srgb(vec3 linear) {
    vec3 light = clamp(linear, 0.0, 1.0);
    return mix(12.92 * light, 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055,
               step(0.0031308, light));
}

vec3 ramp_at(float value) {
    float scaled = clamp(value, 0.0, 1.0) * float(${RAMP.length - 1});
    int below = min(int(scaled), ${RAMP.length - 2});
    return mix(ramp[below], ramp[below + 1], scaled - float(below));
}

void main() {
    vec3 light = vec3(0.0);
    for (int i = 0; i < mix_count; ++i) {
        vec4 entry = texelFetch(mix_table, ivec2(i, 0), 0);
        light += entry.gba * texture(planes, vec3(place, entry.r)).rgb;
    }
    light *= exposure;
    colour = vec4(false_colour ? ramp_at((light.r + light.g + light.b) / 3.0) : srgb(light), 1.0);
}`;
