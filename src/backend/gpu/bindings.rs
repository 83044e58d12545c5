//! Bind group layouts, written out: automatic layouts drop bindings that a kernel does not use, and
//! so differ between kernels.

/// How a kernel uses a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// A uniform buffer of constants.
    Uniform,
    /// A storage buffer, read only.
    Read,
    /// A storage buffer, read and written.
    Write,
}

/// Group 0 of the kernels that work on points: params, scalars, partial sums.
pub const WORKING: &[Access] = &[Access::Uniform, Access::Read, Access::Write];
/// The same with the index of the slab or of the part of a spectrum, where there are several.
pub const WORKING_IN_TURNS: &[Access] = &[
    Access::Uniform,
    Access::Read,
    Access::Write,
    Access::Uniform,
];
/// Group 0 of the kernels that change the scalars.
pub const DECIDING: &[Access] = &[Access::Uniform, Access::Write, Access::Write];
/// Group 2 of the row transforms: roots of unity, work space.
pub const ROWS: &[Access] = &[Access::Read, Access::Write];

/// Group 1 of the columns: roots of unity, work space of each slab, factors, and the spare halves of long
/// columns.
pub fn columns(slabs: usize, long: bool) -> Vec<Access> {
    let mut accesses = vec![Access::Read];
    accesses.extend(vec![Access::Write; slabs]);
    accesses.push(Access::Read);
    accesses.extend(long.then_some(Access::Write));
    accesses
}

/// Group 1 of a kernel of the catalogue: its fields in declared order, the last ones, where they are read
/// as a whole, in so many slabs together.
pub fn fields(reads: usize, writes: usize, whole: usize) -> Vec<Access> {
    let mut accesses = vec![Access::Read; reads];
    accesses.extend(vec![Access::Write; writes]);
    accesses.extend(vec![Access::Read; whole]);
    accesses
}

/// Makes the layout of a group.
pub fn layout(device: &wgpu::Device, accesses: &[Access]) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = accesses
        .iter()
        .zip(0..)
        .map(|(access, binding)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: match access {
                    Access::Uniform => wgpu::BufferBindingType::Uniform,
                    Access::Read => wgpu::BufferBindingType::Storage { read_only: true },
                    Access::Write => wgpu::BufferBindingType::Storage { read_only: false },
                },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &entries,
    })
}

/// Binds buffers to a layout.
pub fn group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    buffers: &[&wgpu::Buffer],
) -> wgpu::BindGroup {
    let entries: Vec<_> = buffers
        .iter()
        .zip(0..)
        .map(|(buffer, binding)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &entries,
    })
}
