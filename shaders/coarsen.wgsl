// Restricts the residual of a level: the transpose of the bilinear interpolation, over the number of finer
// points along a cell. `whole_at` reads the finer field. Written out, since no compiler unrolls loops of a checked shader.
const RATIO: u32 = 2u;

fn at(index: u32, in_domain: bool, line: real) -> real {
    let x = RATIO * (index % WIDTH);
    let y = RATIO * row_of(index);
    let left = before(x, WHOLE_WIDTH);
    let right = after(x + 1u, WHOLE_WIDTH);
    let above = before(y, WHOLE_HEIGHT);
    let below = after(y + 1u, WHOLE_HEIGHT);
    // This cell's own rows, and the nearer ones of the cells before and after.
    let a = vec4<real>(whole_at(left, above), whole_at(x, above), whole_at(x + 1u, above), whole_at(right, above));
    let b = vec4<real>(whole_at(left, y), whole_at(x, y), whole_at(x + 1u, y), whole_at(right, y));
    let c = vec4<real>(whole_at(left, y + 1u), whole_at(x, y + 1u), whole_at(x + 1u, y + 1u), whole_at(right, y + 1u));
    let d = vec4<real>(whole_at(left, below), whole_at(x, below), whole_at(x + 1u, below), whole_at(right, below));
    let far = neighbour_share(0u, RATIO);
    let near = 1.0 - far;
    let columns = (far * (a + d) + near * (b + c)) / real(RATIO);
    write_restricted(index, near * (columns.y + columns.z) + far * (columns.x + columns.w));
    return line;
}
