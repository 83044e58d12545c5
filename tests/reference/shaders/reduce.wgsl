// Sums over a workgroup of GROUP_THREADS threads, halved in a fixed order, SUMS_AT_ONCE of
// SUM_COUNT together, so that barriers are few. GROUP_HALF is the largest power of two below
// GROUP_THREADS; `join_slot` puts two values of a sum together. Every thread must come here.
var<workgroup> group_values: array<part, GROUP_VALUES>;

fn join_min(a: part, b: part) -> part {
    if (leading(b) < leading(a) || is_nan(leading(b))) {
        return b;
    }
    return a;
}

fn join_max(a: part, b: part) -> part {
    if (leading(b) > leading(a) || is_nan(leading(b))) {
        return b;
    }
    return a;
}

// Leaves the results of the sums from `first` on at group_values[0], [GROUP_THREADS], and so on.
fn gather(first: u32, thread: u32) {
    let count = min(SUMS_AT_ONCE, SUM_COUNT - first);
    workgroupBarrier();
    for (var slot = 0u; slot < count; slot = slot + 1u) {
        group_values[slot * GROUP_THREADS + thread] = part_of(first + slot);
    }
    workgroupBarrier();
    for (var half = GROUP_HALF; half > 0u; half = half >> 1u) {
        if (thread < half && thread + half < GROUP_THREADS) {
            for (var slot = 0u; slot < count; slot = slot + 1u) {
                let place = slot * GROUP_THREADS + thread;
                group_values[place] = join_slot(first + slot, group_values[place], group_values[place + half]);
            }
        }
        workgroupBarrier();
    }
}
