/* See robot.h. Kept in step with crates/coinmc-link/src/device/mod.rs: the rules are explained
 * there. */
#include "robot.h"

#include "cycle.h"

static struct {
    coinmc_decoder decoder;
    uint8_t wire[COINMC_MAX_WIRE];
    uint16_t session;  /* 0: none */
    bool has_answered; /* the last request of this session, and its reply */
    uint16_t answered_seq;
    coinmc_reply answered;
    uint16_t rx_bad;
    uint32_t started_ms;
} robot;

void robot_boot(uint32_t now_ms)
{
    memset(&robot, 0, sizeof robot);
    robot.started_ms = now_ms;
    cycle_boot(now_ms);
}

void robot_tick(uint32_t now_ms)
{
    cycle_tick(now_ms);
}

static bool far(int32_t um, int32_t limit)
{
    return um > limit || -um > limit;
}

/* Whether a request exceeds this robot's capabilities or limits. */
static bool exceeds_limits(const coinmc_info *info, const coinmc_request *request)
{
    switch (request->kind) {
    case COINMC_REQUEST_THROW:
        return request->spin_mrev_s > info->spin_mrev_s || request->angle_cdeg > info->angle_cdeg;
    case COINMC_REQUEST_MOVE_CARRIAGE:
        return !(info->capabilities & COINMC_HAS_CARRIAGE) || far(request->x_um, info->x_um) ||
               far(request->y_um, info->y_um);
    case COINMC_REQUEST_LIGHT:
        return !(info->capabilities & COINMC_HAS_LIGHT);
    default:
        return false;
    }
}

static void fill_status(coinmc_status *status, uint32_t now_ms)
{
    sensors now;
    hardware_sense(&now);
    memset(status, 0, sizeof *status);
    status->state = cycle.state;
    status->throw_id = cycle.throw_id;
    status->experiment = cycle.experiment;
    status->spin_mrev_s = cycle.asked_spin;
    status->angle_cdeg = cycle.asked_angle;
    status->released = cycle.released;
    status->meas_spin_mrev_s = cycle.measured ? cycle.release_spin : now.spin_mrev_s;
    status->meas_angle_cdeg = cycle.measured ? cycle.release_angle : now.angle_cdeg;
    status->x_um = now.x_um;
    status->y_um = now.y_um;
    status->t_ms = now_ms - robot.started_ms;
    status->t_release_ms = cycle.measured ? cycle.release_ms - robot.started_ms : 0;
    status->fault = cycle.fault;
    status->rx_bad = robot.rx_bad;
}

static void execute(const coinmc_request *request, uint32_t now_ms, coinmc_reply *reply)
{
    coinmc_info info;
    hardware_info(&info);
    uint8_t nak = CYCLE_DONE;
    if (exceeds_limits(&info, request)) {
        nak = COINMC_NAK_BAD_RANGE;
    } else {
        switch (request->kind) {
        case COINMC_REQUEST_INFO:
            reply->kind = COINMC_REPLY_INFO;
            reply->as.info = info;
            return;
        case COINMC_REQUEST_STATUS:
            reply->kind = COINMC_REPLY_STATUS;
            fill_status(&reply->as.status, now_ms);
            return;
        case COINMC_REQUEST_STOP:
            nak = cycle_stop();
            break;
        case COINMC_REQUEST_HOME:
            nak = cycle_move(request, MOTION_HOME, now_ms);
            break;
        case COINMC_REQUEST_THROW:
            nak = cycle_throw(request, now_ms);
            break;
        case COINMC_REQUEST_MOVE_CARRIAGE:
            nak = cycle_move(request, MOTION_MOVE_CARRIAGE, now_ms);
            break;
        case COINMC_REQUEST_LIGHT:
            hardware_light(request->permille);
            break;
        case COINMC_REQUEST_COLLECT:
            nak = cycle_collect(request, now_ms);
            break;
        case COINMC_REQUEST_CLEAR_FAULT:
            nak = cycle_clear_fault(request);
            break;
        default:
            nak = cycle_set_counter(request);
            break;
        }
    }
    if (nak != CYCLE_DONE) {
        reply->kind = COINMC_REPLY_NAK;
        reply->as.nak = nak;
    } else {
        reply->kind = COINMC_REPLY_OK;
        reply->as.ok.throw_id = cycle.throw_id;
        reply->as.ok.state = cycle.state;
    }
}

static void hello(const coinmc_received *frame, const coinmc_request *request, uint32_t now_ms,
                  coinmc_reply *reply)
{
    if (frame->session != request->session) {
        reply->kind = COINMC_REPLY_NAK;
        reply->as.nak = COINMC_NAK_BAD_RANGE;
        return;
    }
    if (request->major == COINMC_MAJOR) {
        robot.session = request->session;
        robot.has_answered = false;
        cycle_heard(now_ms);
    }
    reply->kind = COINMC_REPLY_HELLO;
    reply->as.hello.major = COINMC_MAJOR;
    reply->as.hello.minor = COINMC_MINOR;
    reply->as.hello.boot = cycle.boot;
    reply->as.hello.throw_id = cycle.throw_id;
    reply->as.hello.state = cycle.state;
}

static void answer(const coinmc_received *frame, uint32_t now_ms, coinmc_reply *reply)
{
    coinmc_request request;
    coinmc_read read = coinmc_read_request(frame->body, frame->length, &request);
    reply->kind = COINMC_REPLY_NAK;
    if (read == COINMC_GOOD && request.kind == COINMC_REQUEST_HELLO) {
        hello(frame, &request, now_ms, reply);
        return;
    }
    if (robot.session == 0 || frame->session != robot.session) {
        reply->as.nak = COINMC_NAK_NO_SESSION;
        return;
    }
    cycle_heard(now_ms);
    if (robot.has_answered && robot.answered_seq == frame->seq) {
        *reply = robot.answered;
        return;
    }
    if (read == COINMC_GOOD)
        execute(&request, now_ms, reply);
    else
        reply->as.nak = read == COINMC_MALFORMED ? COINMC_NAK_BAD_MESSAGE : COINMC_NAK_BAD_RANGE;
    robot.has_answered = true;
    robot.answered_seq = frame->seq;
    robot.answered = *reply;
}

uint8_t robot_receive(uint8_t byte, uint32_t now_ms, const uint8_t **sent)
{
    coinmc_received frame;
    switch (coinmc_push(&robot.decoder, byte, &frame)) {
    case COINMC_FRAME:
        break;
    case COINMC_REJECT:
        if (robot.rx_bad != UINT16_MAX)
            robot.rx_bad++;
        return 0;
    default:
        return 0;
    }
    coinmc_reply reply;
    uint8_t body[COINMC_MAX_BODY];
    answer(&frame, now_ms, &reply);
    *sent = robot.wire;
    return coinmc_frame(frame.session, frame.seq, body, coinmc_write_reply(&reply, body),
                        robot.wire);
}
