//! Makes the shipped tables of sigmoid polynomials, `data/*.sigmoid`:
//! `cargo run --profile fast -p tenfold-spectrum --example sigmoid_tables -- 36 crates/spectrum/data`.

use std::error::Error;
use std::path::Path;

use tenfold_spectrum::RgbColorSpace;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(nodes), Some(folder)) = (arguments.next(), arguments.next()) else {
        return Err("usage: sigmoid_tables NODES FOLDER".into());
    };
    let nodes = nodes.parse()?;
    for space in RgbColorSpace::all() {
        let path = Path::new(&folder).join(format!("{}.sigmoid", space.name()));
        space.make_table(nodes).write(std::fs::File::create(path)?)?;
    }
    Ok(())
}
