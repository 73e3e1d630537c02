/// Begins to load a value into the caches, where the processor has an instruction for that.
#[inline(always)]
pub fn prefetch<T>(what: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        const LINE: usize = 64;
        let start = std::ptr::from_ref(what).cast::<i8>();
        let last = size_of::<T>().saturating_sub(1);
        // Where it does not begin with a line, its end may lie in one more.
        let end = if align_of::<T>() < LINE { Some(last) } else { None };
        for at in (0..size_of::<T>()).step_by(LINE).chain(end) {
            // SAFETY: it is within what is referred to, and every such processor has the instruction.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(start.add(at)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = what;
}
