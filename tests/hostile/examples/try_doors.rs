use hostile::noise::Noise;
fn main() {
    for (name, inputs) in [
        ("link_receive", vec!["fuzz/corpus-seed/link_receive/walk", "fuzz/corpus-seed/link_receive/walk-parity"]),
        ("store_open", std::fs::read_dir("tests/vectors").unwrap().map(|e| e.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "ptn")).map(|p| p.to_str().unwrap().to_owned().leak() as &str).collect()),
        ("update_receive", vec!["fuzz/corpus-seed/update_receive/two-clips"]),
    ] {
        let door = hostile::door(name).unwrap();
        let names = inputs.clone();
        let inputs: Vec<Vec<u8>> = inputs.iter().map(|f| std::fs::read(f).unwrap()).collect();
        println!("{name} {:?}", inputs.iter().zip(names).filter(|(i, _)| !(door.enter)(i)).map(|(_, n)| n).collect::<Vec<_>>());
        let mut noise = Noise::new(1);
        let (mut ok, t) = (0, std::time::Instant::now());
        for _ in 0..3000 {
            let [a, b] = [0; 2].map(|_| noise.below(inputs.len()));
            let d = noise.damage(&inputs[a], &inputs[b], door.words);
            ok += usize::from((door.enter)(&d));
        }
        println!("{name}: {ok} of 3000 in {:?}", t.elapsed());
    }
}
