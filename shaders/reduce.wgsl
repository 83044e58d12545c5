// Sums over a workgroup of GROUP_THREADS threads, halved in a fixed order; GROUP_HALF is the
// largest power of two below GROUP_THREADS. Every thread must come here.
var<workgroup> group_values: array<wide, GROUP_THREADS>;

fn join_add(a: wide, b: wide) -> wide {
    return a + b;
}

fn join_min(a: wide, b: wide) -> wide {
    return select(a, b, b < a || is_nan(b));
}

fn join_max(a: wide, b: wide) -> wide {
    return select(a, b, b > a || is_nan(b));
}

fn gather_add(value: wide, thread: u32) -> wide {
    workgroupBarrier();
    group_values[thread] = value;
    workgroupBarrier();
    for (var half = GROUP_HALF; half > 0u; half = half >> 1u) {
        if (thread < half && thread + half < GROUP_THREADS) {
            group_values[thread] = join_add(group_values[thread], group_values[thread + half]);
        }
        workgroupBarrier();
    }
    return group_values[0];
}

fn gather_min(value: wide, thread: u32) -> wide {
    workgroupBarrier();
    group_values[thread] = value;
    workgroupBarrier();
    for (var half = GROUP_HALF; half > 0u; half = half >> 1u) {
        if (thread < half && thread + half < GROUP_THREADS) {
            group_values[thread] = join_min(group_values[thread], group_values[thread + half]);
        }
        workgroupBarrier();
    }
    return group_values[0];
}

fn gather_max(value: wide, thread: u32) -> wide {
    workgroupBarrier();
    group_values[thread] = value;
    workgroupBarrier();
    for (var half = GROUP_HALF; half > 0u; half = half >> 1u) {
        if (thread < half && thread + half < GROUP_THREADS) {
            group_values[thread] = join_max(group_values[thread], group_values[thread + half]);
        }
        workgroupBarrier();
    }
    return group_values[0];
}
