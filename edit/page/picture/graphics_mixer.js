// Mixes planes into the picture on a canvas, by WebGL 2 on a graphics card.

import { RAMP } from "./false_colour.js";
import { PlaneTexture } from "./plane_texture.js";
import { FRAGMENT, VERTEX } from "./shaders.js";

function compile(gl, type, source) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
        throw new Error(`the picture's shader: ${gl.getShaderInfoLog(shader)}`);
    }
    return shader;
}

// What browsers call WebGL that the processor computes.
const COMPUTED = /swiftshader|llvmpipe|softpipe|software|basic render/i;

/** Whether there is WebGL 2, on a graphics card. */
export function hasGraphicsCard() {
    // A canvas that has been asked for WebGL cannot be drawn on otherwise.
    const gl = document.createElement("canvas").getContext("webgl2",
        { failIfMajorPerformanceCaveat: true });
    if (!gl) return false;
    const info = gl.getExtension("WEBGL_debug_renderer_info");
    const renderer = gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
    gl.getExtension("WEBGL_lose_context")?.loseContext();
    return !COMPUTED.test(renderer);
}

export class GraphicsMixer {
    #gl;
    #uniforms;
    #table;
    #view = null;
    #viewTable;

    /** Where hasGraphicsCard(). */
    constructor(canvas) {
        // What was drawn is kept, for the picture is exported as it is seen.
        this.#gl = canvas.getContext("webgl2", {
            alpha: false, antialias: false, depth: false, preserveDrawingBuffer: true,
        });
        this.#build();
    }

    #build() {
        const gl = this.#gl;
        const program = gl.createProgram();
        gl.attachShader(program, compile(gl, gl.VERTEX_SHADER, VERTEX));
        gl.attachShader(program, compile(gl, gl.FRAGMENT_SHADER, FRAGMENT));
        gl.linkProgram(program);
        gl.useProgram(program);
        const names = ["planes", "mix_table", "mix_count", "exposure", "false_colour", "ramp",
            "has_view", "view_table", "view_steps"];
        this.#uniforms = Object.fromEntries(
            names.map((name) => [name, gl.getUniformLocation(program, name)]));
        gl.uniform1i(this.#uniforms.planes, 0);
        gl.uniform1i(this.#uniforms.mix_table, 1);
        gl.uniform1i(this.#uniforms.view_table, 2);
        gl.uniform3fv(this.#uniforms.ramp, RAMP.flat());
        this.#viewTable = gl.createTexture();
        gl.activeTexture(gl.TEXTURE2);
        gl.bindTexture(gl.TEXTURE_3D, this.#viewTable);
        for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) {
            gl.texParameteri(gl.TEXTURE_3D, axis, gl.CLAMP_TO_EDGE);
        }
        gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
        gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
        this.setView(this.#view);
        gl.activeTexture(gl.TEXTURE1);
        this.#table = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, this.#table);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        gl.activeTexture(gl.TEXTURE0);
    }

    /** After the graphics card was reset: textures made before are gone. */
    rebuild() {
        this.#build();
    }

    /** What the picture is seen through (ViewFeed). */
    setView(view) {
        this.#view = view;
        const gl = this.#gl;
        gl.uniform1i(this.#uniforms.has_view, view ? 1 : 0);
        if (view) {
            gl.activeTexture(gl.TEXTURE2);
            gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
            gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGB8, view.side, view.side, view.side, 0, gl.RGB,
                gl.UNSIGNED_BYTE, view.bytes);
            gl.uniform3f(this.#uniforms.view_steps, view.side, view.least, view.octaves);
        }
        gl.activeTexture(gl.TEXTURE0);
    }

    newPlanes() {
        return new PlaneTexture(this.#gl);
    }

    clear() {
        const gl = this.#gl;
        gl.disable(gl.SCISSOR_TEST);
        gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
        gl.clearColor(0, 0, 0, 1);
        gl.clear(gl.COLOR_BUFFER_BIT);
    }

    /** Draws the columns from `from` to `to` (fractions of the width). */
    draw(planes, mix, { exposure, falseColour = false, from = 0, to = 1 }) {
        const gl = this.#gl;
        const width = gl.drawingBufferWidth;
        const first = Math.round(from * width);
        gl.enable(gl.SCISSOR_TEST);
        gl.scissor(first, 0, Math.round(to * width) - first, gl.drawingBufferHeight);
        const table = new Float32Array(Math.max(mix.length, 1) * 4);
        mix.forEach(({ plane, weight }, index) => table.set([plane, ...weight], index * 4));
        gl.activeTexture(gl.TEXTURE1);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, table.length / 4, 1, 0, gl.RGBA, gl.FLOAT,
            table);
        gl.activeTexture(gl.TEXTURE0);
        gl.bindTexture(gl.TEXTURE_2D_ARRAY, planes.texture);
        gl.uniform1i(this.#uniforms.mix_count, mix.length);
        gl.uniform1f(this.#uniforms.exposure, exposure);
        gl.uniform1i(this.#uniforms.false_colour, falseColour ? 1 : 0);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
}
