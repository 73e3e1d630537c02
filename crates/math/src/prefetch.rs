/// Begins to load a value into the caches, where the processor has an instruction for that.
#[inline(always)]
pub fn prefetch<T>(what: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        const LINE: usize = 64;
        let start = std::ptr::from_ref(what).cast::<i8>();
        // SAFETY: it is within what is referred to, and every such processor has the instruction.
        let load = |at| unsafe { _mm_prefetch::<_MM_HINT_T0>(start.add(at)) };
        // Not an iterator: the compiler does not unroll those that are chained.
        let mut at = 0;
        while at < size_of::<T>() {
            load(at);
            at += LINE;
        }
        // Where it does not begin with a line, its end may lie in one more.
        if align_of::<T>() < LINE {
            load(size_of::<T>().saturating_sub(1));
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = what;
}
