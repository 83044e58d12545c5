// Turns a value by a root of unity, and back by its conjugate.
fn turn(value: vec2<f32>, root: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(value.x * root.x - value.y * root.y, value.x * root.y + value.y * root.x);
}

fn turn_back(value: vec2<f32>, root: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(value.x * root.x + value.y * root.y, value.y * root.x - value.x * root.y);
}
