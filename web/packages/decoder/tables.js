// The tables of the format (decoder/FORMAT.md 6), written by make-tables.mjs: sizes of symbols, and the indices that choose among the tables.
const TEXT = "iLW)_YgaabVW]=Y*i[X5TZq<UISAes|`2QirsQ0Z&gcEV)o'YVS9QfK<9(/*($&' &4O6 /Xu[qXyVhS]S3R;QJK=.'(*$%$&6:4%2$% *Q,QmSKT_UwUUVnUdT+SORRQwR-QMGQ*$$'(&$($)$&% '2DQAQfS8S/TwUQT'TnSkS-TeS3QxUd$$& &'$%$&%$%%$(*$$Q1$QM$QL$QLQLQL &RG$SD$Q9kY$$QL +((($*(( ,%%%&%%}c%%%&%%%% &&)$/%-&))% &&$( 'Qj(dH$[qX(UT$$TRU5TrQkUFSlRGQTU&QyQ]XBQ0LRKQ$ 3>ViTaU,W{TBRAQ^S*QeQ6R/QrQ`QoQkQ@QSQ=M=:/+)**3-Q)Q'R&Q]RdRNSGR:T,R<U+S2VPSEUER3RWQFO>+&$R4R+IUBCSyR%W&Q1RuR=StRQSnRBRsS;QQRD>Q2&.$%$QKQn;XJ*Vy,]'6U./TRJS3;RiQ1HI(/& 'QoQYIR'4Q])SbLS;@T:QBURQEXeRRUyRlS$QDB3+$$TQ8OQ%NQ4RxQ-7QUQ'RZR9Q4BTJRsT$SXT@S~RQRXR&QRQVR~Q&Q_PQsPQHQ<Q,Q8QWQ|Q=RlQ?UmQ|X]ReV`RARgQ;Q#6-MR97^5MQ~Q'UU8ZBQZT=FSY,R%QQQ%M&,$' &SZQ~RQR%Q}QZQbS$QFRwQJRBQFSzQUUmQRUORuRBRMNQ?*2%R1RRR,V8RGRVRcSgQSSjQ7TUQCRyQGTAQIScQ>QtHE/(&.RJQhQvQmQxQrQ@RZQ4R5QCT<Q#TpOX@:WNQ|RbQw?J'*%]#Y]XtSOScQjQrQ3QE>4Q4NQ&0Q&Q8BH;;31--*RAQsQYTQQKR,QhRqQ/S;HU>Q+T,Q:VmQ>U:QdRjQ8L='&'R3FEI.QoBLCQrERM2S&0Z1Q)[oQ7WbQ9RUB>&'Q%Q1QIQ2GQ(Q*Q-H:IM22Q.R9QhRpS4TgSvUcUET;T2RiO-E.'*-0'+*I-*;QNHQmQ/RwQCT2QjTOQbg6ePUQ['QcTMQ-QQ-=A+Q55Q+)2& *.TYV5W{X*W/UFSZRsQiQ9F?*( 4m7T8Q/UnSOR^QbQ1:,% 8:=Q)QZRdSsU2VrWDVQU{T.RWQXQ.7& 1#$%%$$%%&%&&''''(((((((()(((****# &%%%%%&&&&&&&$# &'$(%)%)))&#####'#'#'#'''###)#)##'##'######*'##$%&'%&'()(##$%*$%&'++)##,%&$*&'--)#.,*&*&&'/00#.###########1#####(##1##1########2##1##,##,##2#".replace(/ (.)/g, (_, count) => "$".repeat(count.charCodeAt() - 35));

let at = 0;
const digit = () => {
  const code = TEXT.charCodeAt(at++) - 35;
  return code > 57 ? code - 1 : code;
};
const number = () => {
  const first = digit();
  return first < 46 ? first : 91 * first + digit() - 4140;
};
const indices = (count) => Array.from(Array(count), number);
// Sizes add up to 4096.
const sizes = (count) => {
  const row = indices(count - 1);
  return [...row, row.reduce((left, size) => left - size, 4096)];
};
const rows = (count, width) => Array.from(Array(count), () => sizes(width));

export const STATUS = rows(8, 4);
export const MODE = rows(8, 33);
export const NUMBER = rows(16, 27);
export const STEP_CHANGE = sizes(25);
export const POSITION = sizes(33);
export const VELOCITY = sizes(33);
export const FAR = sizes(32);
export const STATUS_IN = indices(32);
export const MODE_AFTER = indices(65);
export const NUMBER_IN = indices(96);
