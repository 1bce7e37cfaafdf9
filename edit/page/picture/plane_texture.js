// The planes of an image in the graphics memory.

/** One layer of the texture per plane. */
export class PlaneTexture {
    #gl;
    #layout = null;

    constructor(gl) {
        this.#gl = gl;
        this.texture = null;
    }

    /** Takes an image's planes over; the memory is used again while its layout stays the same. */
    upload(image) {
        const gl = this.#gl;
        const { width, height } = image;
        const depth = image.planes.length;
        const layout = `${width} ${height} ${depth}`;
        if (layout !== this.#layout) {
            this.free();
            this.#layout = layout;
            this.texture = gl.createTexture();
            gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.texture);
            // Half floats can be interpolated everywhere, full ones cannot.
            gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGB16F, width, height, depth);
            gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
            gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
            gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
            gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
        }
        gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.texture);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        const type = image.data instanceof Uint16Array ? gl.HALF_FLOAT : gl.FLOAT;
        gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, 0, width, height, depth, gl.RGB, type,
            image.data);
    }

    free() {
        if (this.texture) this.#gl.deleteTexture(this.texture);
        this.texture = null;
        this.#layout = null;
    }
}
