//! A player apart from its memory plays the same poses.

use pantin::{ChannelState, Clip, Player};

#[test]
fn a_detached_player_plays_what_a_player_plays() {
    let walk = Clip::new_checked(include_bytes!("../walk.ptn")).unwrap();
    let run = Clip::new_checked(include_bytes!("../run.ptn")).unwrap();
    let (mut states, mut values) = ([ChannelState::NEW; 64], [0; 64]);
    let (mut other_states, mut other_values) = ([ChannelState::NEW; 64], [0; 64]);
    // One memory for one clip after the other.
    for clip in [walk, run, walk] {
        let mut detached = Player::new(clip, &mut states, &mut values).unwrap().detach();
        let mut player = Player::new(clip, &mut other_states, &mut other_values).unwrap();
        assert_eq!(detached.moving(), clip.moving());
        for _ in 1..clip.frames() {
            detached.step(&mut states, &mut values);
            player.step();
            assert_eq!((detached.frame(), detached.pose(&values).values), (player.frame(), player.pose().values));
        }
        // From the last frame both go to the first.
        for _ in 0..3 {
            detached.step(&mut states, &mut values);
            player.step();
            assert_eq!((detached.frame(), detached.pose(&values).values), (player.frame(), player.pose().values));
        }
        assert_eq!(detached.frame(), 2);
        for frame in [5, 3, clip.frames()] {
            detached.seek(frame, &mut states, &mut values);
            player.seek(frame);
            assert_eq!((detached.frame(), detached.pose(&values).values), (player.frame(), player.pose().values));
        }
        // With what was there at frame 0, it begins again without reading how the channels start.
        detached.seek(0, &mut states, &mut values);
        let start = detached.loop_start().unwrap();
        let starts: Vec<[i32; 2]> =
            states[..detached.moving()].iter().map(|state| [values[state.slot()], state.rates()[0]]).collect();
        for last in [1, 2, 40, clip.frames() - 1] {
            detached.seek(last, &mut states, &mut values);
            assert_eq!(detached.loop_start(), None);
            detached.restart(start, starts.iter().copied(), &mut states, &mut values);
            player.seek(0);
            for _ in 0..50 {
                assert_eq!((detached.frame(), detached.pose(&values).values), (player.frame(), player.pose().values));
                detached.step(&mut states, &mut values);
                player.step();
            }
        }
        detached.seek(7, &mut states, &mut values);
        player.seek(7);
        assert_eq!(detached.attach(&mut states, &mut values).map(|player| player.frame()), Some(player.frame()));
        assert!(detached.attach(&mut [], &mut values).is_none());
    }
}
