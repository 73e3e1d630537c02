//! Large arrays.

/// Room for `n` elements, in huge pages where the system has them: rays jump about in the hierarchy, and translating the address of every
/// small page costs as much as reading it.
pub(crate) fn with_capacity<T>(n: usize) -> Vec<T> {
    let array = Vec::with_capacity(n);
    #[cfg(target_os = "linux")]
    {
        const PAGE: usize = 4096;
        const WORTH: usize = 1 << 21;
        let start = (array.as_ptr() as usize).next_multiple_of(PAGE);
        let bytes = (n * size_of::<T>()).saturating_sub(PAGE) / PAGE * PAGE;
        if bytes >= WORTH {
            // SAFETY: whole pages inside the allocation; the advice changes nothing of what is in them, and none is needed.
            let _ = unsafe { rustix::mm::madvise(start as *mut _, bytes, rustix::mm::Advice::LinuxHugepage) };
        }
    }
    array
}
