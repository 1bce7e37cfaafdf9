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
precision highp sampler3D;
uniform sampler2DArray planes;
uniform sampler2D mix_table;  // per entry: the plane's index, and its weight per channel
uniform int mix_count;
uniform float exposure;
uniform bool false_colour;
uniform bool has_view;
uniform sampler3D view_table;
uniform vec3 view_steps;  // how many, from which light, over how many octaves
uniform vec3 ramp[${RAMP.length}];
in vec2 place;
out vec4 colour;

vec3 srgb(vec3 linear) {
    vec3 light = clamp(linear, 0.0, 1.0);
    return mix(12.92 * light, 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055,
               step(0.0031308, light));
}

vec3 seen(vec3 light) {
    vec3 octaves = log2(1.0 + max(light, 0.0) / view_steps.y);
    vec3 at = min(octaves / view_steps.z, 1.0) * (view_steps.x - 1.0);
    return texture(view_table, (at + 0.5) / view_steps.x).rgb;
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
    vec3 shown = false_colour ? ramp_at((light.r + light.g + light.b) / 3.0)
        : has_view ? seen(light) : srgb(light);
    colour = vec4(shown, 1.0);
}`;
